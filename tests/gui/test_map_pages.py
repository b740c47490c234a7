"""The page, lead and spin of the map that are shown when other candidates come."""

from types import SimpleNamespace

import numpy as np

from posopt_gui.viewmodels.map_model import Choice, Page
from posopt_gui.views.map_header import carried


def test_the_page_stays_with_its_branch_and_the_angles_wherever_they_stand():
    """Without branch 0 the second slot is branch 2, and with a wider sweep the angles move."""
    page = Page(1, 0, 1, "N U T", 10)
    before = SimpleNamespace(leads=np.array([-5.0, 0.0, 5.0]), spins=np.array([0.0]))
    pages = (Page(None, None, None, "", 9), Page(0, 0, 1, "N U T", 5), Page(1, 0, 2, "F U T", 4))
    model = SimpleNamespace(pages=pages, leads=np.array([0.0, 5.0, 10.0]), spins=np.array([1.0]))
    assert carried(Choice(1, 0, 2, 0), page, before, model) == Choice(0, 0, 1, None)
    assert carried(Choice(None, None, 0, None), None, before, model) == Choice()
    gone = Page(3, 0, 5, "N D T", 2)
    assert carried(Choice(3, 0, None, None), gone, before, model) == Choice()

"""Where the user guide lies: with the installed package, or in a checkout of the sources."""

from __future__ import annotations

import importlib.util
from pathlib import Path
from typing import Final

DOCS_PACKAGE: Final = "posopt_docs"
GUIDE: Final = "window.md"


def guide_file() -> Path | None:
    """The guide of the window in English, beside those in other languages; None without one."""
    found = importlib.util.find_spec(DOCS_PACKAGE)
    places = list(found.submodule_search_locations or ()) if found is not None else []
    for folder in (*map(Path, places), Path(__file__).resolve().parents[2] / "docs"):
        if (folder / GUIDE).is_file():
            return folder / GUIDE
    return None

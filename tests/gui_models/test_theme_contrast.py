"""Text can be read on every ground, as WCAG 2.1 asks: a contrast of at least 4.5 to 1."""

import pytest

from posopt_gui.theme import THEMES

GROUNDS = ("window", "surface", "raised", "selection", "plot", "scene")
TEXTS = ("text", "muted", "accent", "error", "warning", "good")


def luminance(colour):
    """Relative luminance of '#RRGGBB' (WCAG 2.1)."""
    parts = [int(colour[at : at + 2], 16) / 255.0 for at in (1, 3, 5)]
    linear = [one / 12.92 if one <= 0.03928 else ((one + 0.055) / 1.055) ** 2.4 for one in parts]
    return sum(share * one for share, one in zip((0.2126, 0.7152, 0.0722), linear, strict=True))


def contrast(one, other):
    low, high = sorted((luminance(one), luminance(other)))
    return (high + 0.05) / (low + 0.05)


@pytest.mark.parametrize("theme", THEMES.values(), ids=lambda theme: theme.name)
def test_text_can_be_read_on_every_ground(theme):
    found = {
        (text, ground): round(contrast(getattr(theme, text), getattr(theme, ground)), 2)
        for text in TEXTS
        for ground in GROUNDS
    }
    assert {pair: value for pair, value in found.items() if value < 4.5} == {}
    assert contrast(theme.accent_text, theme.accent) >= 4.5


def test_the_measure_is_that_of_the_standard():
    assert contrast("#000000", "#FFFFFF") == pytest.approx(21.0)
    assert contrast("#777777", "#FFFFFF") == pytest.approx(4.48, abs=0.01)

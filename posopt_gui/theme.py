"""Colours of the window, light and dark; outcomes from the Okabe-Ito set for the colour-blind."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Final

from solver.candidates.outcomes import Outcome

ROBOT_YELLOW: Final = "#F7C600"
"""The robot alone is yellow."""


@dataclass(frozen=True, slots=True)
class Theme:
    """Named colours as '#RRGGBB'."""

    name: str
    window: str
    surface: str
    raised: str
    border: str
    text: str
    muted: str
    accent: str
    accent_text: str
    selection: str
    error: str
    warning: str
    good: str
    plot: str
    grid: str
    feasible: str
    near: str
    line: str
    scene: str

    @property
    def dark(self) -> bool:
        """Whether this is the dark one."""
        return self.name == "dark"

    def outcome(self, outcome: Outcome) -> str:
        """Colour of a candidate by what became of it."""
        return OUTCOME_COLOURS.get(outcome, self.feasible)


OUTCOME_COLOURS: Final[Mapping[Outcome, str]] = {
    Outcome.UNREACHABLE: "#999999",
    Outcome.JOINT_LIMIT: "#E69F00",
    Outcome.SINGULAR: "#CC79A7",
    Outcome.COLLISION: "#D55E00",
    Outcome.MARGIN: "#882255",
    Outcome.SELF_COLLISION: "#0072B2",
}

LIGHT: Final = Theme(
    name="light",
    window="#F2F4F7",
    surface="#FFFFFF",
    raised="#E9EDF2",
    border="#CBD3DC",
    text="#1B232C",
    muted="#586574",
    accent="#0B5FA5",
    accent_text="#FFFFFF",
    selection="#D6E6F5",
    error="#B3261E",
    warning="#8A5300",
    good="#1E6B3A",
    plot="#FFFFFF",
    grid="#DCE2E9",
    feasible="#B4CBE0",
    near="#F0E442",
    line="#12324F",
    scene="#E4E9EF",
)

DARK: Final = Theme(
    name="dark",
    window="#171B20",
    surface="#1F252C",
    raised="#2A323B",
    border="#3B4653",
    text="#E8EDF2",
    muted="#A2AFBD",
    accent="#6CB4F0",
    accent_text="#0C1620",
    selection="#243E57",
    error="#FF8A80",
    warning="#F2B544",
    good="#7CCB92",
    plot="#1A2026",
    grid="#333D48",
    feasible="#5F7F9F",
    near="#F0E442",
    line="#F4F8FC",
    scene="#20262D",
)

THEMES: Final[Mapping[str, Theme]] = {LIGHT.name: LIGHT, DARK.name: DARK}

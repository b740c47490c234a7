"""The only unit factors of posopt: SI inside, millimetres and degrees where people are."""

from __future__ import annotations

import math
from typing import Final

MM: Final = 1e-3
"""One millimetre [m]."""

DEG: Final = math.pi / 180.0
"""One degree [rad]."""

MM_PER_M: Final = 1e3
"""Millimetres in a metre."""

DEG_PER_RAD: Final = 180.0 / math.pi
"""Degrees in a radian."""

TURN: Final = 2.0 * math.pi
"""One full turn [rad]."""

CM_PER_M: Final = 1e2
"""Centimetres in a metre."""

M_PER_INCH: Final = 0.0254
"""Metres in an inch."""

MS_PER_S: Final = 1e3
"""Milliseconds in a second."""

S_PER_MIN: Final = 60.0
"""Seconds in a minute."""

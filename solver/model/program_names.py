"""Names that no robot program can have, since no file of it could be kept everywhere."""

from __future__ import annotations

import re
from typing import Final

_DEVICE: Final = re.compile(r"CON|PRN|AUX|NUL|(COM|LPT)[0-9]", re.IGNORECASE)


def is_device_name(name: str) -> bool:
    """Whether Windows takes a file of this name, with any suffix, for a device.

    See "Naming Files, Paths, and Namespaces" in Microsoft's Win32 documentation.
    """
    return _DEVICE.fullmatch(name) is not None

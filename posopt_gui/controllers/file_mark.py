"""What a file held when it was last read or written here, to tell when another has written it."""

from __future__ import annotations

import hashlib
import stat
from pathlib import Path

from posopt_gui.document.project_file import SIZE_LIMIT


def mark_of(path: Path) -> bytes | None:
    """A digest of a file's content; None where there is no file that could be a project."""
    try:
        status = path.stat()
        # To open a pipe would wait for who writes into it.
        if not stat.S_ISREG(status.st_mode) or status.st_size > SIZE_LIMIT:
            return None
        with path.open("rb") as stream:
            return hashlib.file_digest(stream, "sha256").digest()
    except (OSError, ValueError):
        return None

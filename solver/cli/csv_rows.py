"""Plain CSV files of six numbers a row, as `posopt fk` and `posopt ik` take them."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from solver.cli.arguments import number
from solver.errors import InputError, Place
from solver.transforms import FloatArray

ROW_LIMIT = 1_000_000
SIZE_LIMIT = 256_000_000


def read_rows(file: str) -> FloatArray:
    """Rows of six numbers separated by commas; `#` begins a comment; returns (n, 6)."""
    path = Path(file)
    try:
        if path.stat().st_size > SIZE_LIMIT:
            raise InputError(f"the file is larger than {SIZE_LIMIT // 1_000_000} MB", Place(file))
        text = path.read_text(encoding="utf-8-sig")
    except OSError as error:
        raise InputError(f"cannot read the file: {error.strerror or error}", Place(file)) from error
    except UnicodeDecodeError as error:
        raise InputError("the file is not UTF-8 text", Place(file)) from error
    rows = []
    for line, content in enumerate(text.splitlines(), start=1):
        bare = content.split("#")[0].strip()
        if bare:
            rows.append(_row(bare, file, line))
        if len(rows) > ROW_LIMIT:
            raise InputError(f"more than {ROW_LIMIT:,} rows", Place(file, line))
    if not rows:
        raise InputError("no row of six numbers was found", Place(file))
    return np.array(rows)


def _row(text: str, file: str, line: int) -> list[float]:
    cells = text.split(",")
    if len(cells) != 6:
        raise InputError(f"expected six numbers, got {len(cells)}", Place(file, line))
    values = []
    for column, cell in enumerate(cells, start=1):
        try:
            values.append(number(cell, "value"))
        except InputError as error:
            raise InputError(error.message, Place(file, line, column)) from error
    return values

"""Toolpaths from files and from the faces of a beam.

An importer is one file with a function ``(Source, ImportOptions) -> Toolpath`` and one line in
:mod:`solver.io.importers.registry`. Each is loaded when it is first used.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

from solver.lazy_names import lazy_names

if TYPE_CHECKING:
    from solver.io.importers.options import ImportOptions as ImportOptions
    from solver.io.importers.parametric import FaceLine as FaceLine
    from solver.io.importers.parametric import ParametricPath as ParametricPath
    from solver.io.importers.parametric import face_line_toolpath as face_line_toolpath
    from solver.io.importers.parametric import parametric_toolpath as parametric_toolpath
    from solver.io.importers.registry import import_source as import_source
    from solver.io.importers.registry import load_toolpath as load_toolpath
    from solver.io.importers.registry import path_source as path_source
    from solver.io.importers.resampling import resample as resample
    from solver.io.importers.source import Source as Source

_HOME: Final = {
    "FaceLine": ".parametric",
    "ImportOptions": ".options",
    "ParametricPath": ".parametric",
    "Source": ".source",
    "face_line_toolpath": ".parametric",
    "import_source": ".registry",
    "load_toolpath": ".registry",
    "parametric_toolpath": ".parametric",
    "path_source": ".registry",
    "resample": ".resampling",
}

__all__ = sorted(_HOME)  # noqa: PLE0605 - a list of strings, kept in one place

__getattr__, __dir__ = lazy_names(__name__, _HOME)

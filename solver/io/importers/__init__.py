"""Toolpaths from files and from the faces of a beam.

An importer is one file with a function ``(Source, ImportOptions) -> Toolpath`` and one line in
:mod:`solver.io.importers.registry`.
"""

from solver.io.importers.options import ImportOptions
from solver.io.importers.parametric import (
    FaceLine,
    ParametricPath,
    face_line_toolpath,
    parametric_toolpath,
)
from solver.io.importers.registry import import_source, load_toolpath, path_source
from solver.io.importers.resampling import resample
from solver.io.importers.source import Source

__all__ = [
    "FaceLine",
    "ImportOptions",
    "ParametricPath",
    "Source",
    "face_line_toolpath",
    "import_source",
    "load_toolpath",
    "parametric_toolpath",
    "path_source",
    "resample",
]

"""Post-processors: one file each, and one line in `POSTS`."""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType

from solver.errors import UnknownNameError
from solver.io.posts.csv_moves import CSV_MOVES
from solver.io.posts.fanuc_cartesian import FANUC_CARTESIAN
from solver.io.posts.fanuc_joint import FANUC_JOINT
from solver.io.posts.json_program import JSON_PROGRAM
from solver.io.posts.post import FileForm, Post, PostOptions, Rendered, RenderedFile

POSTS: Mapping[str, Post] = MappingProxyType(
    {one.name: one for one in (FANUC_JOINT, FANUC_CARTESIAN, CSV_MOVES, JSON_PROGRAM)}
)


def post_named(name: str) -> Post:
    """Return the post-processor of that name, or raise with the names that exist."""
    try:
        return POSTS[name]
    except KeyError:
        raise UnknownNameError("post-processor", name, tuple(POSTS)) from None


__all__ = [
    "POSTS",
    "FileForm",
    "Post",
    "PostOptions",
    "Rendered",
    "RenderedFile",
    "post_named",
]

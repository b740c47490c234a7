"""Post-processors: one file each, and one line in `POSTS`."""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType

from solver.errors import UnknownNameError
from solver.io.posts.fanuc_joint import FANUC_JOINT
from solver.io.posts.post import Post, PostOptions

POSTS: Mapping[str, Post] = MappingProxyType(
    {
        FANUC_JOINT.name: FANUC_JOINT,
    }
)


def post_named(name: str) -> Post:
    """Return the post-processor of that name, or raise with the names that exist."""
    try:
        return POSTS[name]
    except KeyError:
        raise UnknownNameError("post-processor", name, tuple(POSTS)) from None


__all__ = ["POSTS", "Post", "PostOptions", "post_named"]

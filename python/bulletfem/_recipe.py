# SPDX-License-Identifier: Zlib
# Copyright (c) 2026 The BulletFEM authors
"""Worlds that are pickled as their recipe and their state."""
from __future__ import annotations

from collections.abc import Callable
from typing import Any, Optional

from ._core import World

_Builder = Callable[..., World]


def make(builder: _Builder, **arguments: Any) -> World:
    """The world that builder(**arguments) returns. It can be pickled, if the builder and its arguments can: the pickle
    has these and the state, and the world goes on with equal bits in another process."""
    world = builder(**arguments)
    if not isinstance(world, World):
        raise TypeError(f"builder returned {world!r}: it must return a World")
    setattr(world, "_recipe", (builder, arguments))
    return world


def _remake(builder: Optional[_Builder], source: Any, state: bytes) -> World:
    world = World.from_scene(source) if builder is None else make(builder, **source)
    world.restore_state(state)
    return world


def reduce(self: World) -> tuple[Any, ...]:
    """World.__reduce__."""
    recipe = getattr(self, "_recipe", None)
    if recipe is None:
        raise TypeError(
            "a World cannot be pickled unless bulletfem.make(builder, **arguments) or World.from_scene(path) made it: "
            "a pickle has this recipe and the state"
        )
    return _remake, (*recipe, self.save_state())

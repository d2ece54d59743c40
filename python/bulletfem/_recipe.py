# SPDX-License-Identifier: Zlib
# Copyright (c) 2026 The BulletFEM authors
"""Worlds that are pickled as their recipe and their state."""
from __future__ import annotations

from typing import Any, Callable, Optional

from . import _core

_Builder = Callable[..., _core.World]


def make(builder: _Builder, **arguments: Any) -> _core.World:
    """The world that builder(**arguments) returns. It can be pickled, if the builder and its arguments can: the pickle
    has these and the state, and the world goes on with equal bits in another process."""
    world = builder(**arguments)
    if not isinstance(world, _core.World):
        raise TypeError(f"builder returned {world!r}: it must return a World")
    setattr(world, "_recipe", (builder, arguments))
    return world


def _remake(builder: Optional[_Builder], source: Any, state: bytes) -> _core.World:
    world = _core.World.from_scene(source) if builder is None else make(builder, **source)
    world.restore_state(state)
    return world


def reduce(self: _core.World) -> tuple[Any, ...]:
    """World.__reduce__."""
    recipe = getattr(self, "_recipe", None)
    if recipe is None:
        raise TypeError(
            "a World cannot be pickled unless bulletfem.make(builder, **arguments) or World.from_scene(path) made it: "
            "a pickle has this recipe and the state"
        )
    return _remake, (*recipe, self.save_state())

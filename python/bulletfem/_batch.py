# SPDX-License-Identifier: Zlib
# Copyright (c) 2026 The BulletFEM authors
"""Many worlds of one builder, stepped together."""
from __future__ import annotations

from typing import Any, Callable, List, Optional, Union

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _core
from ._recipe import make

_Body = Union[str, int]


class Batch(_core._Batch):
    """n worlds of builder(**arguments), stepped together by threads of C++ (0: all of the machine's).

    Equal bodies are factored once. Every world moves with the bits that it has alone, on any number of threads."""

    def __init__(self, builder: Callable[..., _core.World], n: int, *, threads: int = 0, **arguments: Any) -> None:
        if n < 1:
            raise ValueError(f"n is {n}: a Batch has one world or more")
        shared = _core._SharedBodies()
        try:
            worlds = [make(builder, **arguments) for _ in range(n)]
        finally:
            del shared
        super().__init__(worlds, threads)
        self._start = self.save_states()

    def reset(self, mask: Optional[ArrayLike] = None, states: Optional[Union[bytes, List[bytes]]] = None) -> None:
        """Restores the worlds where mask (n,) is True, or all, to the states that they began with, to one state, or to
        a state each."""
        chosen = np.ones(len(self), bool) if mask is None else np.asarray(mask)
        if chosen.dtype != bool or chosen.shape != (len(self),):
            raise ValueError(f"mask is {chosen.dtype} {chosen.shape}: it must be bool ({len(self)},)")
        if states is None:
            states = self._start
        elif isinstance(states, bytes):
            states = [states] * len(self)
        elif len(states) != len(self):
            raise ValueError(f"states has {len(states)} items: the batch has {len(self)} worlds")
        self.restore_states([state if wanted else None for state, wanted in zip(states, chosen)])

    def set_materials(self, body: _Body, materials: List[_core.Material]) -> None:
        """Gives the soft body of each world a material of its own, and begins anew: all worlds are reset, and reset()
        will restore them to that."""
        if len(materials) != len(self):
            raise ValueError(f"materials has {len(materials)} items: the batch has {len(self)} worlds")
        self.reset()
        for world, material in zip(self.worlds, materials):
            soft = world[body] if isinstance(body, str) else world.body(body)
            soft.set_material(material)
            soft.refactor()
        self._start = self.save_states()

    def rollout(
        self,
        steps: int,
        body: _Body,
        *,
        every: int = 1,
        before: Optional[Callable[[int], object]] = None,
    ) -> NDArray[np.float64]:
        """Makes `steps` steps, and returns the body's node positions after each `every` of them, (k, n, nodes, 3) [m].
        before(step) is called before each step, to move or to push bodies."""
        if steps < 0 or every < 1:
            raise ValueError(f"steps is {steps} and every {every}: they must be >= 0 and >= 1")
        places = self.node_positions(body)
        path = np.empty((steps // every, *places.shape))
        for k in range(steps):
            if before is not None:
                before(k)
            self.step()
            if (k + 1) % every == 0:
                path[k // every] = places
        return path

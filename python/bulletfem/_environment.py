# SPDX-License-Identifier: Zlib
# Copyright (c) 2026 The BulletFEM authors
"""A vector environment with gymnasium's interface: two plates squeeze a soft ball and lift it."""
from __future__ import annotations

import typing
from importlib import import_module
from importlib.util import find_spec
from typing import Any, Optional

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ._batch import Batch
from . import _core

_HAS_GYMNASIUM = find_spec("gymnasium") is not None
_Base: Any = import_module("gymnasium.vector").VectorEnv if _HAS_GYMNASIUM else object

_RADIUS = 0.05  # of the ball [m]
_START = 0.13  # distance of the plates at the beginning [m]
_NARROWEST = 0.05  # smallest distance of the plates [m]
_SPEED = 0.2  # of a plate for an action of 1 [m/s]
_THICKNESS = 0.02  # of a plate [m]
_HIGHEST = 0.5  # of the plates above their beginning [m]
_MODES = ("NextStep", "SameStep", "Disabled")  # values of gymnasium.vector.AutoresetMode


class _Box(typing.NamedTuple):
    """The data of a gymnasium.spaces.Box, where gymnasium is not installed."""

    low: NDArray[np.float64]
    high: NDArray[np.float64]
    shape: tuple[int, ...]


def _box(low: ArrayLike, high: ArrayLike, shape: tuple[int, ...]) -> Any:
    lowest, highest = (np.broadcast_to(np.asarray(bound, float), shape).copy() for bound in (low, high))
    if not _HAS_GYMNASIUM:
        return _Box(lowest, highest, shape)
    return import_module("gymnasium.spaces").Box(lowest, highest, dtype=np.float64)


def _build(young: float) -> _core.World:
    world = _core.World(step=1 / 120)
    world.add_rigid_body(_core.Shape.plane(), name="ground", friction=0.8)
    for name, side in (("left", -1), ("right", 1)):
        place = (side * (_START + _THICKNESS) / 2, _RADIUS, 0)
        shape = _core.Shape.box((_THICKNESS, 0.08, 0.08))
        world.add_rigid_body(shape, name=name, position=place, kinematic=True, friction=1)
    material = _core.Material(young_modulus=young, poisson_ratio=0.45, density=300)
    world.add_soft_body(_core.Mesh.sphere(_RADIUS, 8), material, position=(0, _RADIUS, 0), name="ball", friction=1)
    return world


class SqueezeAndLift(_Base):  # type: ignore[misc]
    """n copies of a ball between two plates, each an environment of gymnasium's VectorEnv: that is its base class where
    gymnasium is installed.

    An action (n, 2), in [-1, 1], is the speed at which the plates close and that at which they rise, in .2 m/s. An
    observation (n, 5) has the distance of the plates and their height [m], the height and the vertical speed of the
    ball's middle [m], [m/s], and the force with which the left plate presses, in weights. The reward is the height of
    the ball above its beginning, in `goal` [m], at which an episode terminates; it is truncated after `length` actions
    of `repeat` steps. `autoreset_mode` is gymnasium's, or its value: 'NextStep', 'SameStep' or 'Disabled'."""

    metadata: dict[str, Any] = {"render_modes": []}

    def __init__(
        self,
        num_envs: int,
        *,
        young: float = 2e4,
        goal: float = 0.15,
        length: int = 200,
        repeat: int = 2,
        threads: int = 0,
        autoreset_mode: Any = "NextStep",
    ) -> None:
        mode = getattr(autoreset_mode, "value", autoreset_mode)
        if mode not in _MODES:
            raise ValueError(f"autoreset_mode is {autoreset_mode!r}: it must be one of {', '.join(_MODES)}")
        if not goal > 0 or length < 1 or repeat < 1:
            raise ValueError("goal, length and repeat must be above 0")
        self.batch = Batch(_build, num_envs, threads=threads, young=young)
        self.num_envs, self._mode = num_envs, mode
        self._goal, self._length, self._repeat = goal, length, repeat
        modes: Any = import_module("gymnasium.vector").AutoresetMode if _HAS_GYMNASIUM else str
        self.metadata = {**type(self).metadata, "autoreset_mode": modes(mode)}
        self.single_action_space, self.action_space = (_box(-1, 1, shape) for shape in ((2,), (num_envs, 2)))
        self.single_observation_space, self.observation_space = (
            _box(-np.inf, np.inf, shape) for shape in ((5,), (num_envs, 5))
        )
        ball = self.batch.worlds[0]["ball"]
        self._shares = ball.masses / ball.masses.sum()
        self._weight = 9.81 * ball.masses.sum()
        self._places, self._speeds = self.batch.node_positions("ball"), self.batch.node_velocities("ball")
        self._gap, self._height = np.full(num_envs, _START), np.zeros(num_envs)
        self._count, self._over = np.zeros(num_envs, int), np.zeros(num_envs, bool)
        self._low = self._middles()

    def reset(
        self, *, seed: Optional[int] = None, options: Optional[dict[str, Any]] = None
    ) -> tuple[NDArray[np.float64], dict[str, Any]]:
        """Begins anew; options["reset_mask"] (n,) chooses environments. Nothing is random, so `seed` has no effect."""
        mask = np.ones(self.num_envs, bool)
        if options and "reset_mask" in options:
            mask = np.asarray(options["reset_mask"])
        self._begin(mask)
        return self._observe(), {}

    def step(
        self, actions: ArrayLike
    ) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.bool_], NDArray[np.bool_], dict[str, Any]]:
        """Observations, rewards, terminations, truncations and infos of an action in each environment."""
        actions = np.asarray(actions, float)
        if actions.shape != (self.num_envs, 2) or not np.isfinite(actions).all():
            raise ValueError(f"actions has shape {actions.shape}: it must be finite ({self.num_envs}, 2)")
        if self._mode == "Disabled" and self._over.any():
            raise RuntimeError("an episode is over: reset it with options={'reset_mask': mask}")
        fresh = self._over.copy()
        speeds = np.where(fresh[:, None], 0, np.clip(actions, -1, 1) * _SPEED)
        for _ in range(self._repeat):
            self._move(speeds)
        self._begin(fresh)  # as NextStep wants it: the action of that step is ignored
        observations = self._observe()
        rise = self._middles() - self._low
        rewards = np.where(fresh, 0, rise / self._goal)
        self._count += ~fresh
        terminations = ~fresh & (rise >= self._goal)
        truncations = ~fresh & ~terminations & (self._count >= self._length)
        self._over = terminations | truncations
        infos: dict[str, Any] = {}
        if self._mode == "SameStep" and self._over.any():
            infos = {"final_obs": observations.copy(), "_final_obs": self._over.copy()}
            self._begin(self._over.copy())
            observations = self._observe()
        return observations, rewards, terminations, truncations, infos

    def close(self, **_: Any) -> None:
        """As gymnasium wants it."""

    def _move(self, speeds: NDArray[np.float64]) -> None:
        step = self.batch.worlds[0].step_size
        self._gap = np.clip(self._gap - 2 * speeds[:, 0] * step, _NARROWEST, _START)
        self._height = np.clip(self._height + speeds[:, 1] * step, 0, _HIGHEST)
        for name, side in (("left", -1), ("right", 1)):
            places = np.zeros((self.num_envs, 3))
            places[:, 0] = side * (self._gap + _THICKNESS) / 2
            places[:, 1] = _RADIUS + self._height
            self.batch.move(name, places)
        self.batch.step()

    def _begin(self, mask: NDArray[np.bool_]) -> None:
        if np.any(mask):
            self.batch.reset(mask)
        self._gap[mask], self._height[mask], self._count[mask], self._over[mask] = _START, 0, 0, False

    def _middles(self) -> NDArray[np.float64]:
        return np.asarray(self._places[:, :, 1] @ self._shares)

    def _observe(self) -> NDArray[np.float64]:
        force = self.batch.contact_forces("ball", "left")[:, 0] / self._weight
        speed = self._speeds[:, :, 1] @ self._shares
        return np.stack([self._gap, self._height, self._middles(), speed, force], axis=1)

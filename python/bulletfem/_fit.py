# SPDX-License-Identifier: Zlib
# Copyright (c) 2026 The BulletFEM authors
"""Many simulations at once: over the workers of an executor, and to fit parameters."""
from __future__ import annotations

import typing
from concurrent.futures import Executor
from typing import Any, Callable, Dict, List, Optional, Tuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

_Parameters = Dict[str, float]
_STEP = 1e-3  # relative change of a parameter for its derivative: above the tolerance of the contact solver
_HALVINGS = 5  # of a step that does not lower the error


def map(function: Callable[[Any], Any], items: typing.Iterable[Any], executor: Optional[Executor] = None) -> List[Any]:
    """function(item) for each item, in order, by the workers of any concurrent.futures executor; here without one.

    Worlds of bulletfem.make() and World.from_scene() can be items and results: they go on with equal bits elsewhere.
    Processes must be started by 'spawn' if a thread of this one steps a world."""
    return list(executor.map(function, items)) if executor is not None else [function(item) for item in items]


class Fit(typing.NamedTuple):
    """The result of fit()."""

    parameters: Dict[str, float]
    error: float  #: root mean square of prediction minus measurement, in units of the measurement's
    iterations: int
    converged: bool  #: the last step changed no parameter by more than the tolerance


def fit(
    simulate: Callable[[List[Dict[str, float]]], ArrayLike],
    measured: ArrayLike,
    start: Dict[str, float],
    *,
    bounds: Optional[Dict[str, Tuple[float, float]]] = None,
    tolerance: float = 1e-3,
    iterations: int = 20,
) -> Fit:
    """Parameters, all above 0, with which simulate() predicts the measured values (m,), by Gauss and Newton's method.

    simulate(list) has k sets of parameters, and returns their predictions (k, m): the worlds of a Batch serve. In each
    iteration it is called for the present set and one with each parameter changed by a thousandth, and for shorter
    steps where needed. Steps are relative; `bounds` limit them."""
    goal = np.asarray(measured, float).ravel()
    if not start or not all(np.isfinite(value) and value > 0 for value in start.values()):
        raise ValueError(f"start is {start!r}: it must have parameters, all finite and above 0")
    if not np.isfinite(goal).all() or goal.size < len(start):
        raise ValueError(f"measured has {goal.size} values: it must have one for each parameter or more, all finite")
    names = list(start)
    limits = np.log([(bounds or {}).get(name, (1e-300, 1e300)) for name in names])
    scale = np.maximum(np.abs(goal), 1e-9 * max(np.abs(goal).max(), 1e-300))

    def errors(points: NDArray[np.float64]) -> NDArray[np.float64]:
        sets = [dict(zip(names, np.exp(point).tolist())) for point in points]
        predicted = np.asarray(simulate(sets), float)
        if predicted.shape != (len(sets), goal.size):
            raise ValueError(f"simulate returned {predicted.shape}: it must return ({len(sets)}, {goal.size})")
        if not np.isfinite(predicted).all():
            raise ValueError("simulate returned values that are not finite")
        return (predicted - goal) / scale

    present = np.clip(np.log([start[name] for name in names]), limits[:, 0], limits[:, 1])
    converged, count = False, 0
    changes = np.vstack([np.zeros(len(names)), np.eye(len(names)) * np.log1p(_STEP)])
    error = np.zeros(0)
    while count < iterations and not converged:
        count += 1
        rows = errors(present + changes)
        error = rows[0]
        slope = (rows[1:] - error).T / np.log1p(_STEP)
        step = np.linalg.lstsq(slope, -error, rcond=None)[0]
        shares = 0.5 ** np.arange(_HALVINGS)
        tries = np.clip(present + shares[:, None] * step, limits[:, 0], limits[:, 1])
        results = errors(tries)
        best = int(np.argmin((results**2).sum(axis=1)))
        if (results[best] ** 2).sum() >= (error**2).sum():
            converged = bool(np.abs(step).max() < 10 * tolerance)
            break
        converged = bool(np.abs(tries[best] - present).max() < tolerance)
        present, error = tries[best], results[best]
    parameters = dict(zip(names, np.exp(present).tolist()))
    return Fit(parameters, float(np.sqrt(np.mean(error**2))), count, converged)

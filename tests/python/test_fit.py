# SPDX-License-Identifier: Zlib
# Copyright (c) 2026 The BulletFEM authors
"""Maps over executors, and fits."""
import importlib.util
import multiprocessing
import os
import pathlib
import shutil
import subprocess
import sys
from concurrent.futures import ProcessPoolExecutor, ThreadPoolExecutor

import numpy as np
import pytest

import bulletfem as bf
from executors import build


def continued(world):
    world.step(20)
    return world


@pytest.mark.parametrize("kind", ["none", "threads", "processes"])
def test_maps_keep_order_and_bits(kind):
    worlds = [bf.make(build, young=young) for young in (2e4, 1e5)]
    expected = []
    for young in (2e4, 1e5):
        world = build(young)
        world.step(20)
        expected.append(world["cube"].positions)
    if kind == "none":
        results = bf.map(continued, worlds)
    elif kind == "threads":
        with ThreadPoolExecutor(2) as executor:
            results = bf.map(continued, worlds, executor)
    else:
        with ProcessPoolExecutor(1, multiprocessing.get_context("spawn")) as executor:
            results = bf.map(continued, worlds, executor)
    for world, positions in zip(results, expected):
        assert world.steps == 20 and np.array_equal(world["cube"].positions, positions)


EXECUTORS = {"dask": ("distributed", []),
             "mpi": ("mpi4py", ["mpirun", "--allow-run-as-root", "--oversubscribe", "-n", "2", sys.executable, "-m", "mpi4py.futures"])}


@pytest.mark.parametrize("kind", EXECUTORS)
def test_maps_over_machines_keep_bits(kind):
    module, launcher = EXECUTORS[kind]
    if importlib.util.find_spec(module) is None or launcher and not shutil.which(launcher[0]):
        pytest.skip(f"there is no {module}: install python3-{module}")
    here = pathlib.Path(__file__).parent
    search = os.pathsep.join([str(here), str(pathlib.Path(bf.__file__).parents[1])])
    done = subprocess.run([*(launcher or [sys.executable]), here / "executors.py", kind], env={**os.environ, "PYTHONPATH": search},
                          capture_output=True, text=True, timeout=120)
    assert done.stdout.endswith("3 equal\n"), done.stdout + done.stderr


def press():
    """A block between frictionless plates, the upper of which goes down."""
    world = bf.World(gravity=(0, 0, 0), contact_tolerance=1e-6, tolerance=1e-7)
    for name, height in (("below", -0.05), ("above", 0.15)):
        world.add_rigid_body(bf.Shape.box((0.5, 0.1, 0.5)), position=(0, height, 0), friction=0, name=name, kinematic=True)
    world.add_soft_body(bf.Mesh.box((0.1, 0.1, 0.1), (3, 3, 3), (-0.05, 0, -0.05)), name="block", friction=0)
    return world


def simulate(sets):
    """Force of the plate and width of the block at two depths."""
    batch = bf.Batch(press, len(sets))
    batch.set_materials("block", [bf.Material(young_modulus=each["young"], poisson_ratio=each["poisson"], density=1000,
                                              stiffness_damping=0.02) for each in sets])
    places, values = batch.node_positions("block"), []
    height = np.full(len(sets), 0.15)
    for depth in (0.004, 0.008):
        for _ in range(20):
            height = np.maximum(height - 0.0005, 0.15 - depth)
            batch.move("above", np.stack([0 * height, height, 0 * height], axis=1))
            batch.step()
        batch.step(30)
        values += [batch.contact_forces("block", "above")[:, 1], np.ptp(places[:, :, 0], axis=1) - 0.1]
    return np.stack(values, axis=1)


def test_fits_find_the_constants_of_a_press():
    truth = {"young": 7e4, "poisson": 0.35}
    result = bf.fit(simulate, simulate([truth])[0], {"young": 2e4, "poisson": 0.2}, bounds={"poisson": (0.05, 0.45)})
    assert result.converged and result.iterations < 10 and result.error < 1e-2
    for name, value in truth.items():
        assert np.isclose(result.parameters[name], value, rtol=0.02), name


def test_fits_report_what_they_cannot_predict():
    result = bf.fit(lambda sets: [[each["a"], each["a"]] for each in sets], [1, 2], {"a": 5})
    assert result.error > 0.1
    result = bf.fit(lambda sets: [[each["a"] ** 2] for each in sets], [9], {"a": 1})
    assert result.converged and np.isclose(result.parameters["a"], 3, rtol=1e-3)
    result = bf.fit(lambda sets: [[each["a"]] for each in sets], [9], {"a": 1}, bounds={"a": (0.5, 4)})
    assert np.isclose(result.parameters["a"], 4)


@pytest.mark.parametrize("simulate, measured, start", [
    (lambda sets: [[1]], [1], {"a": 1}),
    (lambda sets: [[np.nan]] * len(sets), [1], {"a": 1}),
    (lambda sets: [[1]] * len(sets), [1], {"a": 1, "b": 1}),
    (lambda sets: [[1]] * len(sets), [np.inf], {"a": 1}),
    (lambda sets: [[1]] * len(sets), [1], {"a": -1}),
    (lambda sets: [[1]] * len(sets), [1], {}),
])
def test_bad_input_is_refused(simulate, measured, start):
    with pytest.raises(ValueError):
        bf.fit(simulate, measured, start)

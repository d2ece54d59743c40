#!/usr/bin/env python3
# SPDX-License-Identifier: Zlib
# Copyright (c) 2026 The BulletFEM authors
"""Times and memory of the Python module: PYTHONPATH=build/release/python measure.py [build/release/tests/python/bulletfem_python_twin]"""
import os
import statistics
import subprocess
import sys
import time

import numpy as np

import bulletfem as bf

PAGE = os.sysconf("SC_PAGE_SIZE") / 1e6  # [MB]


def best(function, repeats, count):
    """Least time of a call [s]."""
    times = []
    for _ in range(repeats):
        start = time.perf_counter()
        for _ in range(count):
            function()
        times.append((time.perf_counter() - start) / count)
    return min(times)


def memory():
    """Memory of the process [MB]."""
    with open("/proc/self/statm") as file:
        return int(file.read().split()[1]) * PAGE


def measure_import():
    code = "import numpy, time; t = time.perf_counter(); import bulletfem; print(time.perf_counter() - t)"
    least = min(float(subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True).stdout) for _ in range(7))
    print(f"import beyond numpy: {1000 * least:.0f} ms")


def measure_arrays():
    body = bf.World().add_soft_body(bf.Mesh.box((1, 1, 1), (16, 12, 13)))
    out = np.empty((body.node_count, 3))
    print(f"{body.tet_count} elements, {body.node_count} nodes: copy {1e6 * best(lambda: body.positions, 20, 1000):.2f} us, into an array "
          f"{1e6 * best(lambda: body.get_positions(out=out), 20, 1000):.2f} us, view {1e6 * best(lambda: body.positions_view, 20, 1000):.2f} us")


def box_on_plane(cells=3):
    world = bf.World()
    world.add_rigid_body(bf.Shape.plane())
    world.add_soft_body(bf.Mesh.box((0.4,) * 3, (cells,) * 3, (-0.2, 0.1, -0.2)), bf.Material.rubber())
    return world


def measure_steps(twin):
    empty, count = bf.World(), 1000
    empty.step(100)
    singly = [best(empty.step, 1, count) - best(lambda: empty.step(count), 1, 1) / count for _ in range(15)]
    print(f"call of step: {1e6 * statistics.median(singly):.2f} us")
    if not twin:
        return
    ratios = []
    for _ in range(15):
        world = box_on_plane()
        start = time.perf_counter()
        for _ in range(120):
            world.step()
        here = time.perf_counter() - start
        ratios.append(here / float(subprocess.run([twin, "time"], capture_output=True, text=True, check=True).stdout))
    print(f"120 calls of step over the same in C++: {statistics.median(ratios):.3f}, the middle of 15 pairs")


def build():
    world = bf.World()
    world.add_rigid_body(bf.Shape.plane())
    world.add_soft_body(bf.Mesh.box((0.2, 0.2, 0.2), (6, 6, 6), (0, 0.02, 0)), bf.Material.rubber(), name="cube")
    return world


def measure_batch():
    before, start = memory(), time.perf_counter()
    batch = bf.Batch(build, 64, threads=1)
    seconds = time.perf_counter() - start
    print(f"64 worlds of {batch.worlds[0]['cube'].tet_count} elements: set-up {seconds:.2f} s, {(memory() - before) / 64:.2f} MB a world")
    pair = bf.Batch(build, 64, threads=2)
    ratios = []
    for _ in range(5):
        times = []
        for each in (batch, pair):
            start = time.perf_counter()
            each.step(12)
            times.append(time.perf_counter() - start)
        ratios.append(times[1] / times[0])
    equal = np.array_equal(batch.node_positions("cube"), pair.node_positions("cube"))
    print(f"two threads over one: {statistics.median(ratios):.2f}, the middle of five, {'equal' if equal else 'OTHER'} bits; "
          f"{(memory() - before) / 128:.2f} MB a world in contact")


if __name__ == "__main__":
    measure_import()
    measure_arrays()
    measure_steps(sys.argv[1] if len(sys.argv) > 1 else "")
    measure_batch()

# SPDX-License-Identifier: Zlib
# Copyright (c) 2026 The BulletFEM authors
"""Maps worlds over an executor of dask or MPI: python executors.py dask, mpirun -n 3 python -m mpi4py.futures executors.py mpi.

Prints how many worlds went on with the bits that they have here."""
import os
import sys

import numpy as np

import bulletfem as bf

YOUNGS = (2e4, 1e5, 5e5)


def build(young=1e5):
    world = bf.World()
    world.add_rigid_body(bf.Shape.plane())
    mesh = bf.Mesh.box((0.2, 0.2, 0.2), (2, 2, 2), (0, 0.01, 0))
    world.add_soft_body(mesh, bf.Material(young_modulus=young, poisson_ratio=0.3, density=1000), name="cube")
    return world


def continued(world):
    """The world after 20 steps, and the process that made them."""
    world.step(20)
    return world, os.getpid()


def check(executor):
    from executors import build, continued  # by this name workers import them

    results = bf.map(continued, [bf.make(build, young=young) for young in YOUNGS], executor)
    equal = 0
    for young, (world, process) in zip(YOUNGS, results):
        assert process != os.getpid()
        here = build(young)
        here.step(20)
        equal += np.array_equal(world["cube"].positions, here["cube"].positions)
    print(f"{equal} equal")


def main(kind):
    if kind == "dask":
        from distributed import Client, LocalCluster

        with LocalCluster(n_workers=1, threads_per_worker=1, dashboard_address=None) as cluster, Client(cluster) as client:
            check(client.get_executor())
    else:
        from mpi4py.futures import MPIPoolExecutor

        with MPIPoolExecutor() as executor:
            check(executor)


if __name__ == "__main__":
    main(sys.argv[1])

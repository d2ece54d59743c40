# SPDX-License-Identifier: Zlib
# Copyright (c) 2026 The BulletFEM authors
"""Runs an example of pybullet unedited, without a window and for some steps: run_example.py <example> <steps> <output>.

Writes, as JSON, the processor time of a step [ms], and for each body the nodes of a soft body, or place and orientation, as
hexadecimal numbers."""
import itertools
import json
import runpy
import sys
import time

import pybullet as p

SOFT_BODY = 3  # BT_SOFT_BODY of pybullet's getDynamicsInfo


def main(example, steps, output):
    connect, step, is_connected = p.connect, p.stepSimulation, p.isConnected
    times, count = [], itertools.count()

    def timed():
        start = time.process_time()
        step()
        times.append(time.process_time() - start)

    p.connect = lambda *_: connect(p.DIRECT)
    p.stepSimulation = timed
    p.isConnected = lambda: next(count) < steps and is_connected()
    runpy.run_path(example)
    bodies = []
    for k in range(p.getNumBodies()):
        body = p.getBodyUniqueId(k)
        soft = p.getDynamicsInfo(body, -1)[10] == SOFT_BODY
        points = p.getMeshData(body, -1, flags=p.MESH_DATA_SIMULATION_MESH)[1] if soft else p.getBasePositionAndOrientation(body)
        bodies.append({"soft": soft, "values": [[value.hex() for value in point] for point in points]})
    times.sort()
    with open(output, "w") as file:
        json.dump({"milliseconds": 1000 * times[len(times) // 2], "steps": len(times), "bodies": bodies}, file)


if __name__ == "__main__":
    main(sys.argv[1], int(sys.argv[2]), sys.argv[3])

# SPDX-License-Identifier: Zlib
# Copyright (c) 2026 The BulletFEM authors
"""A clamped beam whose stiffness varies along its length, by an array of one value per element."""
import numpy as np

import bulletfem

mesh = bulletfem.Mesh.box(size=(1.0, 0.1, 0.1), cells=(20, 2, 2))
middles = mesh.positions[mesh.tets].mean(axis=1)
stiffness = 1e6 * (1 + 9 * (1 - middles[:, 0]))  # ten times as stiff at the clamp
materials = bulletfem.ElementMaterials(bulletfem.Material(density=500), young_modulus=stiffness)
clamp = np.flatnonzero(mesh.positions[:, 0] == 0)

world = bulletfem.World(numerical_damping=1)
beam = world.add_soft_body(mesh, materials, pins=clamp)
world.step(240)
force, moment, count = beam.reaction()
print(f"the end sinks by {-beam.positions[-1, 1] + 0.1:.4f} m")
print(f"{count} nodes hold {force[1]:.2f} N and {moment[2]:.2f} N m")

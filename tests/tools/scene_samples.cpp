// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "tools/scene_samples.h"

#include <sstream>

#include "bullet_fem/fem/baked/baked_body.h"
#include "bullet_fem/fem/mesh/generators.h"
#include "bullet_fem/io/tet_mesh_writer.h"

namespace bullet_fem
{

std::string layeredMesh(const TetMesh& mesh)
{
    std::ostringstream text;
    text.precision(17);
    text << "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n" << mesh.nodeCount() << '\n';
    for (int i = 0; i < mesh.nodeCount(); ++i)
    {
        const Vec3& x = mesh.restPositions()[i];
        text << i + 1 << ' ' << x.x << ' ' << x.y << ' ' << x.z << '\n';
    }
    text << "$EndNodes\n$Elements\n" << mesh.tetCount() << '\n';
    for (int e = 0; e < mesh.tetCount(); ++e)
    {
        double y = 0;
        for (const int node : mesh.tets()[e]) y += mesh.restPositions()[node].y / 4;
        text << e + 1 << " 4 2 " << (y < 0.5 ? 1 : -2) << " 1";
        for (const int node : mesh.tets()[e]) text << ' ' << node + 1;
        text << '\n';
    }
    text << "$EndElements\n";
    return text.str();
}

void writeSampleMeshes(const TemporaryFolder& folder)
{
    folder.write("cube.off",
                 "OFF\n8 6 0\n0 0 0\n1 0 0\n0 1 0\n1 1 0\n0 0 1\n1 0 1\n0 1 1\n1 1 1\n"
                 "4 0 2 3 1\n4 4 5 7 6\n4 0 1 5 4\n4 2 6 7 3\n4 0 4 6 2\n4 1 3 7 5\n");
    const TetMesh block = makeBox({1, 1, 1}, {2, 2, 2});
    writeTetMeshFile(folder.path("two.node"), block);
    folder.write("regions.msh", layeredMesh(block));
    BakeSettings settings;
    settings.m_step = 0.01;
    writeBakedBody(folder.path("body.bfem"), bakeBody(block, settings));
}

std::string fullScene()
{
    return R"({
  "$schema": "scene.schema.json",
  "title": "everything",
  "gravity": [0, 0, -5],
  "step": 0.004,
  "seconds": 2.5,
  "framesPerSecond": 24,
  "solver": { "coupled": false, "tolerance": 1e-4, "contactTolerance": 1e-3, "threads": 2 },
  "materials": {
    "gum": { "like": "rubber", "young": 3e5, "poisson": 0.41, "density": 900, "massDamping": 0.2, "stiffnessDamping": 0.03, "meanDilatation": "on",
      "bending": "plain", "yieldStress": 5e4, "hardening": 1e4, "plasticCreep": 3, "mostPlasticStrain": 0.3, "relaxation": [{ "share": 0.2, "time": 0.5 }] },
    "tyre": { "shoreA": 65, "density": 1150 },
    "roller": { "shoreD": 55 },
    "timber": { "density": 450, "loss": { "factor": 0.02, "frequency": 40 }, "orthotropic": { "young": [1e7, 2e6, 1e6], "poisson": [0.37, 0.47, 0.43], "shear": [7e5, 6e5, 1e5],
      "axes": [[0, 0, 2], [1, 1, 0]] } }
  },
  "softBodies": [
    {
      "name": "block",
      "mesh": { "box": [1, 2, 3], "holes": [{ "low": [-9, -9, 1], "high": [-8, 8, 2] }], "cell": 0.5, "scale": 0.25 },
      "position": [0.5, 1.5, -2],
      "rotation": { "axis": [0, 0, 2], "degrees": 90 },
      "velocity": [1, 2, 3],
      "material": { "like": "gum", "young": 4e5, "poisson": 0.2, "density": 800, "massDamping": 0.1, "stiffnessDamping": 0.01 },
      "friction": 0.9,
      "restitution": 0.3,
      "selfContact": true,
      "colour": [0.1, 0.2, 0.3],
      "pins": [{ "low": [-9, -9, -9], "high": [9, 9, 0] }, { "low": [1, 1, 1], "high": [2, 2, 2] }]
    },
    { "name": "scan", "mesh": { "surface": "cube.off", "tets": 500, "grade": 1.5, "levels": 2, "scale": 0.5, "surfaceCollides": true } }
  ],
  "rigidBodies": [
    {
      "name": "hammer",
      "shape": { "capsule": { "radius": 0.2, "height": 0.7 } },
      "mass": 3,
      "position": [4, 5, 6],
      "rotation": { "axis": [1, 0, 0], "degrees": -45 },
      "velocity": [0, 1, 0],
      "spin": [0, 0, 2],
      "friction": 0.4,
      "restitution": 0.6,
      "colour": [1, 0, 0.5]
    },
    { "name": "anvil", "shape": { "box": [0.1, 0.2, 0.3] }, "velocity": [[2, [0, 0.5, 0]], [1, [0.25, 0, 0]]], "spin": [[0.5, [1, 2, 3]]] }
  ],
  "constraints": [
    { "kind": "anchor", "soft": "block", "rigid": "hammer", "nodes": { "low": [-9, -9, -9], "high": [9, 9, 9] } },
    { "kind": "hinge", "body": "hammer", "to": "anvil", "pivot": [1, 1, 1], "axis": [0, 0, 1], "speed": 2, "torque": 7 }
  ],
  "welds": [{ "a": "block", "b": "scan", "reach": 0.5, "breakForce": 7, "breakStress": 8e3, "breakStretch": 0.25, "compliance": 1e-6 }],
  "forces": [
    { "body": "block", "nodes": { "low": [-9, -9, -9], "high": [9, 9, 9] }, "force": [1, 0, -1], "from": 0.5, "to": 1.5 }
  ],
  "springs": [
    { "body": "scan", "at": [1, 1, 1], "target": [[0.5, [1, 2, 3]], [1.5, [3, 2, 1]]], "stiffness": 400, "damping": 5, "force": 60, "from": 0.25, "to": 2 }
  ],
  "actuators": [
    { "kind": "chamber", "body": "block", "cavity": 1, "pressure": [[0.5, 0], [1.5, 20000]], "sealedFrom": 2 },
    { "kind": "cable", "body": "block", "through": [[0, 1, 0], [1, 2, 0], [1, 3, 0]], "stiffness": 500, "restLength": 0.4 },
    { "kind": "fibres", "body": "scan", "region": { "low": [-9, -9, -9], "high": [9, 0, 9] }, "direction": [0, 2, 0], "activation": 3000 },
    { "kind": "expansion", "body": "scan", "region": { "low": [-9, 0, -9], "high": [9, 9, 9] }, "strain": 0.02 }
  ],
  "sensors": [
    { "name": "clamp", "body": "block", "nodes": { "low": [-9, -9, -9], "high": [9, 9, 0] }, "about": [0.5, 1, 2] },
    { "name": "grip", "body": "block", "to": "hammer" }
  ],
  "camera": { "eye": [5, 4, 3], "target": [0, 1, 0], "fieldOfView": 60 },
  "pictures": { "width": 640, "height": 360, "stress": true, "hottest": 2e5, "forces": true, "wireframe": true }
})";
}

std::string otherScene()
{
    return R"({
  "softBodies": [
    { "name": "tets", "mesh": { "tetrahedra": "two.node" }, "material": "jelly" },
    { "name": "baked", "mesh": { "baked": "body.bfem" } },
    { "name": "layers", "mesh": { "tetrahedra": "regions.msh" }, "materials": { "1": "rubber", "-2": { "like": "rubber", "young": 3e7, "density": 2000 } } },
    { "name": "bubble", "mesh": { "sphere": 0.3, "cell": 0.1 },
      "pieces": { "cells": 7, "seed": 3, "breakForce": 10, "breakStress": 2e3, "breakStretch": 0.01, "compliance": 1e-7 } },
    { "name": "drum", "mesh": { "cylinder": { "radius": 0.3, "height": 0.2 }, "tets": 400 }, "fracture": { "tension": 3e4, "mostCracks": 4, "partsTouch": false } },
    { "name": "toy", "mesh": { "box": [0.1, 0.1, 0.1], "tets": 5 }, "position": [0, 1, 0],
      "copies": { "count": [2, 1, 3], "spacing": [0.5, 2, -0.4], "turned": true } }
  ],
  "rigidBodies": [
    { "name": "ground", "shape": { "plane": [0, 1, 0] } },
    { "name": "ball", "shape": { "sphere": 0.3 }, "mass": 2 },
    { "name": "rod", "shape": { "cylinder": { "radius": 0.1, "height": 2 } }, "mass": 1 },
    { "name": "crate", "shape": { "box": [0.1, 0.1, 0.1] }, "mass": 1, "copies": { "count": [2, 1, 1], "spacing": [0.5, 0, 0] } }
  ],
  "constraints": [
    { "kind": "point", "body": "ball", "to": "rod", "pivot": [0, 1, 0] },
    { "kind": "slider", "body": "rod", "pivot": [0, 0, 1], "axis": [0, 0, 2], "speed": [[0.5, 0.1], [2, 0.3]], "force": 9 }
  ],
  "forces": [{ "body": "ball", "force": [0, 5, 0] }],
  "actuators": [{ "kind": "cable", "body": "tets", "through": [[0, 0, 0], [0, 1, 0]], "tension": [[0, 5]] }],
  "camera": { "direction": [1, 2, 3] }
})";
}

}  // namespace bullet_fem

// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "benchmarks/stiffness/world_cubes.h"

#include <cmath>

#include "benchmarks/stiffness/jaw_motion.h"
#include "bullet_fem/btFemHelpers.h"

namespace bullet_fem
{
namespace
{

constexpr double kGravity = 9.81;      // [m/s2]
constexpr double kRestSeconds = 2;     // of the cube on the plane [s]
constexpr double kRestFriction = 0.5;  // [-]

btSoftBody& addCube(BenchmarkWorld& world, const TetMesh& mesh, const StiffnessCase& of, double friction)
{
    btFemMaterial material;
    material.m_youngModulus = btScalar(of.m_young);
    material.m_poissonRatio = btScalar(of.material().m_poissonRatio);
    material.m_density = btScalar(StiffnessCase::kDensity);
    material.m_stiffnessDamping = btScalar(of.material().m_stiffnessDamping);
    btSoftBody& cube = world.addSoft(btFemHelpers::createFromTetMesh(world.bullet().getWorldInfo(), mesh), material,
                                     friction, StiffnessCase::kStep);
    cube.setActivationState(DISABLE_DEACTIVATION);
    return cube;
}

btTransform at(double z)
{
    return btTransform(btQuaternion::getIdentity(), btVector3(0, 0, btScalar(z)));
}

// Moved by its motion state, which the world keeps.
btRigidBody& addJaw(BenchmarkWorld& world, double halfSize, double z)
{
    const btVector3 half(1, 1, 1);
    btRigidBody& jaw = world.addRigid(new btBoxShape(btScalar(halfSize) * half), 0, btVector3(0, 0, btScalar(z)), 0);
    jaw.setCollisionFlags(jaw.getCollisionFlags() | btCollisionObject::CF_KINEMATIC_OBJECT);
    jaw.setActivationState(DISABLE_DEACTIVATION);
    const auto state = std::make_shared<btDefaultMotionState>(at(z));
    jaw.setMotionState(state.get());
    world.keep(state);
    return jaw;
}

double fastestNode(const btSoftBody& body)
{
    double fastest = 0;
    for (int i = 0; i < body.m_nodes.size(); ++i) fastest = std::max(fastest, double(body.m_nodes[i].m_v.length()));
    return fastest;
}

double distanceFromOrigin(const btSoftBody& body)
{
    btVector3 sum(0, 0, 0);
    for (int i = 0; i < body.m_nodes.size(); ++i) sum += body.m_nodes[i].m_x;
    return double(sum.length()) / body.m_nodes.size();
}

void count(const btFemStepReport& report, CubeFigures& figures)
{
    figures.m_sweeps.add(report.m_contactSweeps);
    figures.m_iterations.add(report.m_contactIterations);
    figures.m_isTooSoft = figures.m_isTooSoft || (report.m_flags & BT_FEM_TOO_SOFT) != 0;
}

}  // namespace

CubeFigures pressInWorld(const StiffnessCase& of, BenchmarkLine line, double gravity)
{
    const double h = StiffnessCase::kStep;
    const JawMotion jaws{JawMotion::kCells * of.m_edge};
    BenchmarkWorld world(btFemSolverInfo(), line, {0, 0, btScalar(-gravity)});
    btSoftBody& cube = addCube(world, jaws.mesh(), of, 0);
    const double half = jaws.m_height;
    const auto place = [&](double side, double time) { return side * (jaws.distanceAt(time) + half); };
    btRigidBody& lower = addJaw(world, half, place(-1, 0));
    btRigidBody& upper = addJaw(world, half, place(1, 0));
    CubeFigures figures;
    double force = 0;
    int atRest = 0;
    for (int k = 0; k * h < JawMotion::kEnd; ++k)
    {
        lower.getMotionState()->setWorldTransform(at(place(-1, (k + 1) * h)));
        upper.getMotionState()->setWorldTransform(at(place(1, (k + 1) * h)));
        world.bullet().stepSimulation(btScalar(h), 0);
        count(world.fem().stepReport(&cube), figures);
        figures.m_fastest = std::max(figures.m_fastest, fastestNode(cube) / jaws.speed());
        if (k * h < JawMotion::kAtRest) continue;
        ++atRest;
        force -= double(world.fem().contactForce(&cube, &upper).z());
    }
    figures.m_force = force / (atRest * jaws.force(of.m_young));
    figures.m_isThrown = !(distanceFromOrigin(cube) < jaws.m_height / 2);
    return figures;
}

CubeFigures restOnPlane(const StiffnessCase& of)
{
    const double h = StiffnessCase::kStep;
    const JawMotion size{JawMotion::kCells * of.m_edge};
    BenchmarkWorld world(btFemSolverInfo(), BenchmarkLine::swap, {0, 0, btScalar(-kGravity)});
    btSoftBody& cube = addCube(world, size.mesh(size.m_height / 2), of, kRestFriction);
    btRigidBody& plane = world.addRigid(new btStaticPlaneShape(btVector3(0, 0, 1), 0), 0, {0, 0, 0}, 1);
    CubeFigures figures;
    double force = 0;
    for (int k = 0; k * h < kRestSeconds; ++k)
    {
        world.bullet().stepSimulation(btScalar(h), 0);
        if (k * h < kRestSeconds / 2) continue;
        count(world.fem().stepReport(&cube), figures);
        figures.m_fastest = std::max(figures.m_fastest, fastestNode(cube));
        force += double(world.fem().contactForce(&cube, &plane).z());
    }
    const double weight = StiffnessCase::kDensity * std::pow(size.m_height, 3) * kGravity;
    figures.m_force = force / (figures.m_sweeps.m_steps * weight);
    figures.m_isThrown = !(distanceFromOrigin(cube) < 2 * size.m_height);
    return figures;
}

}  // namespace bullet_fem

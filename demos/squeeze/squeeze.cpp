// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// A scan or another closed surface is drawn between two rollers and recovers its shape behind them.
#include <algorithm>
#include <cmath>

#include "bullet_fem/btFemHelpers.h"
#include "bullet_fem/io/surface_file.h"
#include "demos/common/demo.h"
#include "demos/common/demo_measures.h"
#include "demos/common/demo_world.h"

namespace
{
using namespace bullet_fem;

constexpr double kLength = 0.6, kRoller = 0.3, kTable = 0.8;  // of the body, radius, height of the tables [m]
constexpr double kSpin = 2;                                   // of the rollers [rad/s]

/// A ring of 0.6 m, the default body.
SurfaceMesh ring()
{
    SurfaceMesh mesh;
    const int around = 32, across = 16;
    for (int i = 0; i < around; ++i)
        for (int j = 0; j < across; ++j)
        {
            const double u = SIMD_2_PI * i / around, v = SIMD_2_PI * j / across, r = 0.2 + 0.1 * std::cos(v);
            mesh.m_vertices.push_back({r * std::cos(u), 0.1 * std::sin(v), r * std::sin(u)});
            const int next = (i + 1) % around * across, here = i * across, up = (j + 1) % across;
            mesh.m_triangles.push_back({here + j, here + up, next + j});
            mesh.m_triangles.push_back({next + j, here + up, next + up});
        }
    return mesh;
}

btRigidBody& addRoller(DemoWorld& world, double height)
{
    btRigidBody& roller = world.addRigid(new btCylinderShapeZ(at(kRoller, kRoller, 0.4)), 0, at(0, height, 0));
    roller.setCollisionFlags(btCollisionObject::CF_KINEMATIC_OBJECT);
    roller.setActivationState(DISABLE_DEACTIVATION);
    return roller;
}

void play(Demo& demo, const std::string& file, double young, double gapShare, double friction)
{
    DemoWorld world;
    world.addGround();
    CageSettings cage;
    cage.m_targetTets = 3000;
    const SurfaceMesh surface = lyingDown(file.empty() ? ring() : readSurfaceFile(file), kLength);
    btSoftBody* body = btFemHelpers::createFromSurface(world.info(), surface, cage);
    btFemMaterial material;
    material.m_youngModulus = btScalar(young);
    const btVector3 size = sizeOf(*body);
    const std::vector<double> before = volumesOf(*body);
    body->translate(at(-kRoller - size.x() / 2, kTable + 0.002, 0) - at(0, lowestOf(*body).y(), 0));
    body->setVelocity(at(kSpin * kRoller, 0, 0));
    btFemHelpers::updateEmbeddedSurface(body);
    world.addSoft(body, material, friction);

    // The top of the lower roller is above the tables, whose edges would otherwise stop the body; the gap is a fraction
    // of the body's height.
    const double gap = gapShare * double(size.y()), low = kTable + 0.03;
    btRigidBody* rollers[2];
    for (const int upper : {0, 1}) rollers[upper] = &addRoller(world, upper ? low + gap + kRoller : low - kRoller);
    for (const double side : {-1.0, 1.0})
        world.addRigid(new btBoxShape(at(0.7, 0.05, 0.4)), 0, at(0.82 * side, kTable - 0.05, 0), 0.05);
    demo.paint(*rollers[1], {0.45, 0.52, 0.60});
    demo.look(at(1.7, 1.55, 2.7), at(0.1, 0.86, 0));

    double thinnest = 10, fastest = 0;
    do
    {
        for (const int upper : {0, 1})  // kinematic pose after the step; Bullet derives the spin from the difference
            rollers[upper]->getWorldTransform().setRotation(
                btQuaternion(at(0, 0, 1), btScalar((upper ? 1 : -1) * kSpin * (demo.time() + kDemoStep))));
        if (std::abs(double(centreOf(*body).x())) > 0.1) continue;
        double bottom = 10, top = 0;
        for (int i = 0; i < body->m_nodes.size(); ++i)
            if (std::abs(double(body->m_nodes[i].m_x.x())) < 0.06)
            {
                bottom = std::min(bottom, double(body->m_nodes[i].m_x.y()));
                top = std::max(top, double(body->m_nodes[i].m_x.y()));
            }
        thinnest = std::min(thinnest, top - bottom);
        fastest = std::max(fastest, double(velocityOf(*body).x()));
    } while (demo.step(world.bullet()));
    const std::vector<double> after = volumesOf(*body);
    double volumes[2] = {0, 0}, smallest = 1;
    for (std::size_t t = 0; t < after.size(); ++t)
    {
        volumes[0] += before[t];
        volumes[1] += after[t];
        smallest = std::min(smallest, after[t] / before[t]);
    }
    demo.check("centre behind the rollers", centreOf(*body).x(), kRoller, 2, "m", 3);
    demo.check("thickness between them / gap", thinnest / gap, 0.85, 1.15, "", 3);
    demo.check("speed between them / rollers'", fastest / (kSpin * kRoller), 0.8, 1.4, "", 3);
    demo.check("volume after / before", volumes[1] / volumes[0], 0.97, 1.03, "", 3);
    demo.check("smallest element after / before", smallest, 0.5, 1, "", 3);
}

}  // namespace

int main(int argc, char** argv)
{
    Demo demo("squeeze", "A scan or another closed surface is drawn between two rollers.", 3);
    std::string file;
    double young = 1e5, gap = 0.7, friction = 0.9;
    demo.option("--mesh", file, "closed surface: OFF, OBJ, STL or PLY file; a ring without it");
    demo.option("--young", young, 1e3, 1e9, "Young's modulus [Pa]");
    demo.option("--gap", gap, 0.05, 2, "gap of the rollers / height of the body [-]");
    demo.option("--friction", friction, 0, 2, "friction of the body [-]");
    return demo.run(argc, argv, [&] { play(demo, file, young, gap, friction); });
}

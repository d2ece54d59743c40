// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// A hundred soft toys fall into a pit. Each one is a surface of overlapping balls embedded in a cage of tetrahedra.
#include <algorithm>
#include <cmath>

#include "bullet_fem/btFemHelpers.h"
#include "demos/common/demo.h"
#include "demos/common/demo_measures.h"
#include "demos/common/demo_world.h"

namespace
{
using namespace bullet_fem;

constexpr double kPit = 1.2, kThick = 0.1;  // half width and half thickness of the walls [m]

void appendBall(const Vec3& centre, double radius, SurfaceMesh& mesh)
{
    const int rings = 6, around = 10, first = static_cast<int>(mesh.m_vertices.size());
    for (int i = 0; i <= rings; ++i)
        for (int j = 0; j < around; ++j)
        {
            const double u = SIMD_PI * i / rings, v = SIMD_2_PI * j / around;
            mesh.m_vertices.push_back(centre +
                                      radius * Vec3{std::sin(u) * std::cos(v), std::cos(u), std::sin(u) * std::sin(v)});
        }
    for (int i = 0; i < rings; ++i)
        for (int j = 0; j < around; ++j)
        {
            const int a = first + i * around + j, b = first + i * around + (j + 1) % around;
            if (i > 0) mesh.m_triangles.push_back({a, b, a + around});
            if (i < rings - 1) mesh.m_triangles.push_back({b, b + around, a + around});
        }
}

/// A bear with body, head, two ears, arms and legs, 0.36 m high.
SurfaceMesh bear()
{
    SurfaceMesh mesh;
    appendBall({0, 0, 0}, 0.11, mesh);
    appendBall({0, 0.15, 0}, 0.08, mesh);
    for (const double side : {-1.0, 1.0})
    {
        appendBall({0.07 * side, 0.215, 0}, 0.035, mesh);
        appendBall({0.12 * side, 0.05, 0.04}, 0.045, mesh);
        appendBall({0.08 * side, -0.1, 0.06}, 0.055, mesh);
    }
    return mesh;
}

void play(Demo& demo, double count, double young, double wall, double drop)
{
    btFemSolverInfo info;
    info.m_contactTolerance = btScalar(1e-2);  // enough for a crowd
    DemoWorld world(info);
    std::vector<btRigidBody*> pit = {&world.addGround(0.6)};
    for (const double side : {-1.0, 1.0})
    {
        const double out = side * (kPit + kThick);
        pit.push_back(
            &world.addRigid(new btBoxShape(at(kThick, wall / 2, kPit + 2 * kThick)), 0, at(out, wall / 2, 0), 0.6));
        pit.push_back(&world.addRigid(new btBoxShape(at(kPit, wall / 2, kThick)), 0, at(0, wall / 2, out), 0.6));
    }
    btFemMaterial foam = btFemMaterial::foam();
    foam.m_youngModulus = btScalar(young);
    foam.m_density = 100;
    CageSettings cage;
    cage.m_targetTets = 250;
    const SurfaceMesh surface = bear();
    std::vector<btSoftBody*> toys;
    double weight = 0;
    for (int k = 0; k < int(count); ++k)
    {
        btSoftBody* toy = btFemHelpers::createFromSurface(world.info(), surface, cage);
        toy->rotate(btQuaternion(at(std::sin(k), std::cos(2 * k), 0.3).normalized(), btScalar(0.7 * k)));
        toy->translate(at(0.42 * (k % 4 - 1.5), 0.3 + drop + 0.37 * (k / 16), 0.42 * (k / 4 % 4 - 1.5)));
        btFemHelpers::updateEmbeddedSurface(toy);
        toys.push_back(&world.addSoft(toy, foam, 0.5));
        weight += massOf(*toy) * kGravity;
    }
    demo.look(at(3.1, 4.8, 5.6), at(0, 0.9, 0));

    double carried = 0, lowest = 0, farthest = 0, fastest = 0;
    int samples = 0;
    do
    {
        if (demo.time() < 4) continue;
        for (const btSoftBody* toy : toys)
            for (const btRigidBody* part : pit) carried += double(world.fem().contactForce(toy, part).y());
        ++samples;
    } while (demo.step(world.bullet()));
    for (const btSoftBody* toy : toys)
    {
        const btVector3 centre = centreOf(*toy);
        lowest = std::min(lowest, double(lowestOf(*toy).y()));
        farthest = std::max({farthest, std::abs(double(centre.x())), std::abs(double(centre.z()))});
        fastest = std::max(fastest, double(velocityOf(*toy).length()));
    }
    demo.figure("toys", count, "");
    demo.figure("fastest at the end", fastest, "m/s");
    demo.check("force of the pit / weight", carried / samples / weight, 0.97, 1.03, "", 5);
    demo.check("farthest centre from the middle", farthest, 0, kPit, "m", 5);
    demo.check("lowest node", lowest, -0.01, 0, "m", 5);
    demo.check("fastest at the end", fastest, 0, 0.3, "m/s", 5);
}

}  // namespace

int main(int argc, char** argv)
{
    Demo demo("crowd", "A hundred soft toys fall into a pit.", 5);
    double count = 100, young = 5e4, wall = 1.2, drop = 0;
    demo.option("--toys", count, 1, 400, "number of toys [-]");
    demo.option("--young", young, 1e2, 1e9, "Young's modulus [Pa]");
    demo.option("--wall", wall, 0.02, 10, "height of the pit [m]");
    demo.option("--drop", drop, 0, 1e3, "additional initial height [m]");
    return demo.run(argc, argv, [&] { play(demo, count, young, wall, drop); });
}

// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// Soft bodies fall into a heap. Their state is saved on the way and restored at the end; the second run is bitwise
// equal.
#include <cstdint>
#include <cstdio>

#include "bullet_fem/btFemHelpers.h"
#include "bullet_fem/btFemWorldState.h"
#include "bullet_fem/fem/mesh/generators.h"
#include "demos/common/demo.h"
#include "demos/common/demo_measures.h"
#include "demos/common/demo_world.h"

namespace
{
using namespace bullet_fem;

/// FNV-1a hash over the bytes of the state.
std::uint64_t hashOf(const btFemSoftBodySolver& fem, std::vector<unsigned char>& bytes)
{
    fem.saveState(bytes);
    std::uint64_t hash = 14695981039346656037u;
    for (const unsigned char byte : bytes) hash = (hash ^ byte) * 1099511628211u;
    return hash;
}

void play(Demo& demo, double nudge)
{
    DemoWorld world;
    world.addGround();
    std::vector<btSoftBody*> bodies;
    for (int k = 0; k < 9; ++k)
    {
        const bool ball = k % 2;
        btSoftBody* body = ball ? btFemHelpers::createFromTetMesh(world.info(), makeSphere(0.22, 6))
                                : btFemHelpers::createBox(world.info(), at(0, 0, 0), at(.2, .2, .2), btScalar(0.1));
        body->rotate(btQuaternion(at(1, 0.4 * k, 0.3).normalized(), btScalar(0.5 * k)));
        body->translate(at(0.18 * (k % 3 - 1), 0.4 + 0.44 * k, 0.12 * (k / 3 - 1)));
        btFemMaterial material;
        material.m_youngModulus = btScalar(ball ? 1e5 : 4e4);
        bodies.push_back(&world.addSoft(body, material, 0.4));
    }
    demo.look(at(2.5, 3.2, 8.8), at(0.2, 1.6, 0));

    // Steps per phase: before the save, after it, repetition.
    const int part = static_cast<int>(demo.seconds() / kDemoStep) / 3;
    std::vector<unsigned char> saved, bytes;
    std::vector<std::uint64_t> hashes;
    int step = 0, different = 0, restored = 0;
    do
    {
        if (step == part) btFemWorldState::save(world.bullet(), world.fem(), saved);

        if (step >= part && step < 2 * part) hashes.push_back(hashOf(world.fem(), bytes));
        if (step == 2 * part)
        {
            restored = btFemWorldState::restore(world.bullet(), world.fem(), saved.data(), saved.size());
            if (nudge > 0) bodies[0]->m_nodes[0].m_v += at(nudge, 0, 0);
        }
        if (step >= 2 * part && step < 3 * part)
            different += hashOf(world.fem(), bytes) != hashes[static_cast<std::size_t>(step - 2 * part)];
        ++step;
    } while (demo.step(world.bullet()));
    demo.figure("bytes of a state", double(saved.size()), "");
    if (!hashes.empty())
        std::printf("hash of the last state: %016llx\n", static_cast<unsigned long long>(hashes.back()));
    demo.check("states that were restored", restored, 1, 1, "");
    demo.check("steps compared", double(hashes.size()), 1, 1e9, "");
    demo.check("steps with other bits", different, 0, 0, "");
}

}  // namespace

int main(int argc, char** argv)
{
    Demo demo("replay", "Soft bodies fall; their state is saved and restored, and the replay is bitwise equal.", 4.5);
    double nudge = 0;
    demo.option("--nudge", nudge, 0, 1, "speed given to a node after the state is restored [m/s]");
    return demo.run(argc, argv, [&] { play(demo, nudge); });
}

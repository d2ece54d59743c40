// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// A game: the baked body falls bitwise as in the baking tool.
#ifdef BULLETFEM_AMALGAM
#include "bullet_fem_runtime.h"
#else
#include <bullet_fem/btFemHelpers.h>
#include <bullet_fem/fem/baked/baked_body.h>
#endif

#include <iostream>

#include "drop_bits.h"

int main(int argc, char** argv)
{
    if (argc != 2) return 2;
    const std::string name = argv[1];
    const bullet_fem::BakedBody baked = bullet_fem::readBakedBody(name + ".bfem");
    DropWorld world;
    btSoftBody* body = btFemHelpers::createFromBaked(world.m_world.getWorldInfo(), baked);
    world.m_fem.useBaked(body, baked);
    const std::uint64_t bits = world.bitsAfterDrop(body);
    std::uint64_t expected = 0;
    std::ifstream(name + ".bits") >> expected;
    std::cout << "bits " << bits << ", expected " << expected << ", baked " << world.m_baked << std::endl;
    return bits == expected && world.m_touches && world.m_baked ? 0 : 1;
}

// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "python/core/world_state.h"

#include <cstdint>
#include <cstring>
#include <stdexcept>
#include <string>

#include "bullet_fem/btFemWorldState.h"
#include "tools/scene/scene_world.h"

namespace bullet_fem::python
{

void WorldState::save(World& world, std::vector<unsigned char>& bytes)
{
    std::vector<unsigned char> state;
    btFemWorldState::save(world.bullet().world(), world.fem(), state);
    const std::int64_t steps = world.m_steps;
    bytes.resize(sizeof steps);
    std::memcpy(bytes.data(), &steps, sizeof steps);
    bytes.insert(bytes.end(), state.begin(), state.end());
}

void WorldState::restore(World& world, const unsigned char* data, std::size_t size)
{
    std::int64_t steps = 0;
    if (size < sizeof steps) throw std::invalid_argument("the state has " + std::to_string(size) + " bytes");
    std::memcpy(&steps, data, sizeof steps);
    if (steps < 0) throw std::invalid_argument("the state is damaged: it has " + std::to_string(steps) + " steps");
    for (const BodyEntry& body : world.m_bodies)
        if (body.m_soft && !world.fem().isFem(body.m_soft->m_body))
            world.fem().prepare(body.m_soft->m_body, btScalar(world.m_step));
    btFemWorldState::restore(world.bullet().world(), world.fem(), data + sizeof steps, size - sizeof steps);
    world.m_steps = long(steps);
    if (SceneWorld* scene = world.bullet().scene()) scene->setSteps(world.m_steps);
}

}  // namespace bullet_fem::python

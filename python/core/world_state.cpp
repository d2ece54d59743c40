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
namespace
{

/// The number of steps, and its complement, by which damage is found; btFemWorldState finds it in its own bytes.
struct StepCount
{
    std::int64_t m_steps = 0, m_complement = ~std::int64_t(0);
};

}  // namespace

void WorldState::save(World& world, std::vector<unsigned char>& bytes)
{
    std::vector<unsigned char> state;
    btFemWorldState::save(world.bullet().world(), world.fem(), state);
    const StepCount count{world.m_steps, ~std::int64_t(world.m_steps)};
    bytes.resize(sizeof count);
    std::memcpy(bytes.data(), &count, sizeof count);
    bytes.insert(bytes.end(), state.begin(), state.end());
}

void WorldState::restore(World& world, const unsigned char* data, std::size_t size)
{
    StepCount count;
    if (size < sizeof count)
        throw std::invalid_argument("the state is cut off: it has " + std::to_string(size) + " bytes");
    std::memcpy(&count, data, sizeof count);
    if (count.m_steps < 0 || count.m_complement != ~count.m_steps)
        throw std::invalid_argument("the state is damaged, or is none of save_state()");
    for (const BodyEntry& body : world.m_bodies)
        if (body.m_soft && !world.fem().isFem(body.m_soft->m_body))
            world.fem().prepare(body.m_soft->m_body, btScalar(world.m_step));
    btFemWorldState::restore(world.bullet().world(), world.fem(), data + sizeof count, size - sizeof count);
    world.m_steps = long(count.m_steps);
    if (SceneWorld* scene = world.bullet().scene()) scene->setSteps(world.m_steps);
}

}  // namespace bullet_fem::python

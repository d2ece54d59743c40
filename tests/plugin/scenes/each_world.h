// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <gtest/gtest.h>

#include <string>
#include <tuple>

#include "plugin/scenes/soft_world.h"

namespace bullet_fem
{

/// A test over the classes of Bullet's worlds.
class EachWorld : public testing::TestWithParam<WorldClass>
{
};

/// A test over the classes of worlds and another parameter.
template <class T>
class EachWorldWith : public testing::TestWithParam<std::tuple<WorldClass, T>>
{
protected:
    static WorldClass worldClass()
    {
        return std::get<0>(testing::TestWithParam<std::tuple<WorldClass, T>>::GetParam());
    }
    static const T& value() { return std::get<1>(testing::TestWithParam<std::tuple<WorldClass, T>>::GetParam()); }
};

/// The parameters of EachWorld.
inline auto eachWorld()
{
    return testing::Values(WorldClass::softRigid, WorldClass::softMultiBody, WorldClass::deformable);
}

inline std::string nameOfWorld(const testing::TestParamInfo<WorldClass>& suite)
{
    return worldName(suite.param);
}

/// Test names for EachWorldWith; `name` names the other parameter.
template <class Name>
auto nameOfWorldWith(Name name)
{
    return [name](const auto& suite)
    { return std::string(worldName(std::get<0>(suite.param))) + "_" + name(std::get<1>(suite.param)); };
}

}  // namespace bullet_fem

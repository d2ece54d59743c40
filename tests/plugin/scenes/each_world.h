// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <gtest/gtest.h>

#include <string>
#include <tuple>

#include "plugin/scenes/soft_world.h"

namespace bullet_fem
{

/// What holds in each class of Bullet's worlds.
class EachWorld : public testing::TestWithParam<WorldClass>
{
};

/// And for each of other values.
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

/// To be instantiated over.
inline auto eachWorld()
{
    return testing::Values(WorldClass::softRigid, WorldClass::softMultiBody, WorldClass::deformable);
}

inline std::string nameOfWorld(const testing::TestParamInfo<WorldClass>& suite)
{
    return worldName(suite.param);
}

/// Names for EachWorldWith; `name` gives one to the other value.
template <class Name>
auto nameOfWorldWith(Name name)
{
    return [name](const auto& suite)
    { return std::string(worldName(std::get<0>(suite.param))) + "_" + name(std::get<1>(suite.param)); };
}

}  // namespace bullet_fem

// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "bullet_bridge/rigid/enclosing_world.h"

#include <gtest/gtest.h>

#include "BulletSoftBody/btSoftMultiBodyDynamicsWorld.h"
#include "BulletSoftBody/btSoftRigidDynamicsWorld.h"

namespace bullet_fem
{
namespace
{

template <class World>
class EnclosingWorldTest : public testing::Test
{
protected:
    // A class of a program that adds members of its own.
    struct Derived : World
    {
        Derived() : World(nullptr, nullptr, nullptr, nullptr) {}
        int m_more[8] = {};
    };
};

using Worlds = testing::Types<btSoftRigidDynamicsWorld, btSoftMultiBodyDynamicsWorld>;
TYPED_TEST_SUITE(EnclosingWorldTest, Worlds);

TYPED_TEST(EnclosingWorldTest, IsFoundByTwoOfItsMembers)
{
    typename TestFixture::Derived world, other;
    const btDynamicsWorld* expected = &world;
    EXPECT_EQ(enclosingWorld(world.getSoftBodyArray(), world.getDispatchInfo()), expected);
    EXPECT_EQ(enclosingWorld(world.getSoftBodyArray(), other.getDispatchInfo()), nullptr);
}

TYPED_TEST(EnclosingWorldTest, IsNoneIfAMemberIsAProgramsOwn)
{
    typename TestFixture::Derived world;
    const btAlignedObjectArray<btSoftBody*> bodies;
    const btDispatcherInfo info;
    EXPECT_EQ(enclosingWorld(bodies, world.getDispatchInfo()), nullptr);
    EXPECT_EQ(enclosingWorld(world.getSoftBodyArray(), info), nullptr);
}

}  // namespace
}  // namespace bullet_fem

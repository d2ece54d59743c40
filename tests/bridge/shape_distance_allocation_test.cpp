// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// Distance queries allocate nothing. A separate program: it replaces operator new and Bullet's allocators by counting
// ones.
#include <gtest/gtest.h>

#include <cstdlib>
#include <new>

#include "BulletCollision/CollisionShapes/btCompoundShape.h"
#include "LinearMath/btAlignedAllocator.h"
#include "bridge/bridge_test_shapes.h"
#include "bridge/concave_test_shapes.h"
#include "bullet_bridge/contact/rigid/sheet_contact.h"

namespace
{

int allocations = 0;

void* countedAlloc(std::size_t size)
{
    ++allocations;
    return std::malloc(size);
}
void countedFree(void* memory)
{
    std::free(memory);
}
void* countedAlignedAlloc(std::size_t size, int alignment)
{
    ++allocations;
    return std::aligned_alloc(alignment, (size + alignment - 1) / alignment * alignment);
}

}  // namespace

// The compiler inlines only one of the pair.
#pragma GCC diagnostic ignored "-Wmismatched-new-delete"

void* operator new(std::size_t size)
{
    if (void* memory = countedAlloc(size ? size : 1)) return memory;
    throw std::bad_alloc();
}
void operator delete(void* memory) noexcept
{
    std::free(memory);
}
void operator delete(void* memory, std::size_t) noexcept
{
    std::free(memory);
}

namespace bullet_fem
{

TEST(ShapeDistanceAllocation, NothingIsAllocatedOnceTheLeavesHaveRoom)
{
    btAlignedAllocSetCustom(countedAlloc, countedFree);
    btAlignedAllocSetCustomAligned(countedAlignedAlloc, countedFree);
    std::vector<ShapePtr> shapes;
    btCompoundShape compound;
    for (const NamedShape& solid : convexSolids())
    {
        shapes.push_back(solid.m_make());
        compound.addChildShape(btTransform::getIdentity(), shapes.back().get());
    }
    btCollisionObject object;
    object.setCollisionShape(&compound);
    btAlignedObjectArray<ShapeLeaf> leaves;
    collectShapeLeaves(object, leaves);
    ASSERT_EQ(leaves.size(), int(shapes.size()));
    ASSERT_GT(allocations, 0);

    RandomPoints random;
    allocations = 0;
    int found = 0, inside = 0;
    for (int i = 0; i < 100; ++i)
    {
        leaves.resizeNoInitialize(0);
        collectShapeLeaves(object, leaves);
        for (int k = 0; k < leaves.size(); ++k)
        {
            SurfaceDistance point, triangle;
            found += pointShapeDistance(leaves[k], random.inBox(1), 1e30, point);
            found += triangleShapeDistance(leaves[k], random.triangle(0.5, 0.5), 1e30, triangle);
            inside += triangle.m_gap < -0.1;
        }
    }
    EXPECT_EQ(allocations, 0);
    EXPECT_EQ(found, 200 * leaves.size());
    EXPECT_GT(inside, 300);
}

TEST(SheetContactAllocation, NothingIsAllocatedOnceTheScratchHasGrown)
{
    btAlignedAllocSetCustom(countedAlloc, countedFree);
    btAlignedAllocSetCustomAligned(countedAlignedAlloc, countedFree);
    GridSettings hills;
    hills.m_height = [](btScalar x, btScalar y) { return btScalar(0.2) * btCos(3 * x) * btCos(4 * y); };
    for (const NamedConcave& named : concaveShapes())
    {
        const ConcaveShape shape = named.m_make(hills);
        const ShapeLeaf leaf = leafOf(shape.shape());
        TriangleSoup soup;
        std::vector<SheetContact> touches;
        std::size_t found = 0;
        const auto search = [&]
        {
            soup.collect(leaf, {-2, -2, -4}, {2, 2, 4});
            for (double x = -1.5; x < 1.5; x += 0.1)
            {
                SheetProbe probe;
                probe.m_position = probe.m_rightSide = {x, 0.3, 0.25 + named.m_height};
                probe.m_path = {0.3, 0.1, -0.3};
                probe.m_band = 0.05;
                findPointContacts(soup, probe, touches);
                found += touches.size();
                SheetFeature feature;
                feature.m_corners = {probe.m_position, {x + 0.3, 0.4, 0.1}, {x + 0.1, 0.7, 0.1}};
                feature.m_outward = {0, 0, -1};
                feature.m_reach = feature.m_depth = 0.5;
                findCornerContacts(soup, feature, touches);
                findEdgeContacts(soup, feature, touches);
            }
        };
        search();
        allocations = 0;
        search();
        EXPECT_EQ(allocations, 0) << named;
        EXPECT_GT(found, 0u);
    }
}

}  // namespace bullet_fem

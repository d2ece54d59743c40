// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "bullet_bridge/geometry/shapes/swept_distance.h"

#include <gtest/gtest.h>

#include <limits>

#include "bridge/bridge_test_shapes.h"

namespace bullet_fem
{

namespace
{

constexpr double kSweep = 1.0 / 60;
const double kNan = std::numeric_limits<double>::quiet_NaN();

SweptFeature node(const Vec3& x, const Vec3& v = {})
{
    return {1, {x}, {v}};
}
SweptFeature edge(const Vec3& a, const Vec3& b, const Vec3& v = {})
{
    return {2, {a, b}, {v, v}};
}
SweptFeature triangle(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& v = {})
{
    return {3, {a, b, c}, {v, v, v}};
}

/// A shape that moves from a place with a velocity and a spin about that place.
SweptShape sweep(btCollisionShape& shape, const Vec3& from, const Vec3& velocity, const Vec3& spin = {})
{
    ShapeLeaf leaf = leafOf(shape);
    leaf.m_pose.m_origin = from;  // not through Bullet's floats
    leaf.m_boundsMin += from;
    leaf.m_boundsMax += from;
    return SweptShape(leaf, {from, velocity, spin}, kSweep);
}

bool touches(const SweptShape& shape, const SweptFeature& feature)
{
    SweptContact contact;
    return sweptDistance(shape, feature, 0, contact);
}
SweptContact touchOf(const SweptShape& shape, const SweptFeature& feature, double offset = 0)
{
    SweptContact contact;
    EXPECT_TRUE(sweptDistance(shape, feature, offset, contact));
    return contact;
}

/// The row's gap equals the distance covered by the relative velocity until contact.
void expectRowStopsAtTouch(const SweptShape& shape, const SweptFeature& feature, const SweptContact& contact)
{
    const Vec3 rigid = shape.m_motion.m_linearVelocity + cross(shape.m_motion.m_angularVelocity, contact.m_arm);
    const double closing =
        dot(contact.m_surface.m_normal, rigid - interpolate(feature.m_velocity, contact.m_surface.m_barycentric));
    EXPECT_NEAR(contact.m_surface.m_gap, contact.m_time * closing, 1e-9 * closing * kSweep);
}

/// Runs each case at the origin and far from it, where floats are 8 micrometres apart.
class SweptDistance : public ::testing::TestWithParam<double>
{
protected:
    Vec3 m_origin = {GetParam(), -GetParam(), 0.5 * GetParam()};
    btSphereShape m_sphere{btScalar(0.01)};
};

}  // namespace

INSTANTIATE_TEST_SUITE_P(, SweptDistance, ::testing::Values(0.0, 100.0),
                         [](const auto& far) { return far.param > 0 ? "far" : "near"; });

TEST_P(SweptDistance, FastSphereHitsNodesWithinItsRadiusOfThePath)
{
    const double radius = m_sphere.getRadius();
    const SweptShape swept = sweep(m_sphere, m_origin, {100, 0, 0});
    EXPECT_FALSE(touches(swept, node(m_origin + Vec3{1, 1.00001 * radius, 0})));
    for (double share : {0.0, 0.5, 0.9, 0.999})
    {
        const SweptFeature feature = node(m_origin + Vec3{1, share * radius, 0});
        const SweptContact contact = touchOf(swept, feature);
        const double half = radius * std::sqrt(1 - share * share);
        EXPECT_NEAR(contact.m_time, (1 - half) / 100, 1e-6 * (1 - half) / 100) << share;
        EXPECT_NEAR(norm(contact.m_surface.m_normal - Vec3{half / radius, share, 0}), 0, 1e-4) << share;
        EXPECT_NEAR(norm(contact.m_arm), radius, 1e-6 * radius) << share;
        expectRowStopsAtTouch(swept, feature, contact);
    }
}

TEST_P(SweptDistance, OnlyRelativeMotionCounts)
{
    const SweptShape still = sweep(m_sphere, m_origin, {}), along = sweep(m_sphere, m_origin, {50, 0, 0});
    const Vec3 ahead = m_origin + Vec3{0.5, 0.003, 0};
    const SweptContact a = touchOf(still, node(ahead, {-50, 0, 0})), b = touchOf(along, node(ahead));
    EXPECT_NEAR(a.m_time, b.m_time, 1e-6 * b.m_time);
    EXPECT_NEAR(norm(a.m_surface.m_normal - b.m_surface.m_normal), 0, 1e-4);
    EXPECT_FALSE(touches(along, node(ahead, {50, 0, 0})));
    EXPECT_FALSE(touches(along, node(ahead, {60, 0, 0})));
}

TEST_P(SweptDistance, LateOrSeparatingObjectsMakeNoContact)
{
    EXPECT_FALSE(touches(sweep(m_sphere, m_origin, {100, 0, 0}), node(m_origin + Vec3{2, 0, 0})));
    EXPECT_FALSE(touches(sweep(m_sphere, m_origin, {-100, 0, 0}), node(m_origin + Vec3{0.011, 0, 0})));
    EXPECT_FALSE(touches(sweep(m_sphere, m_origin, {}), node(m_origin + Vec3{0.011, 0, 0})));
}

TEST_P(SweptDistance, InitialContactHasTheGapAtStepStart)
{
    const SweptShape swept = sweep(m_sphere, m_origin, {-100, 0, 0});
    const SweptContact inside = touchOf(swept, node(m_origin + Vec3{0.008, 0, 0}));
    EXPECT_EQ(inside.m_time, 0);
    EXPECT_NEAR(inside.m_surface.m_gap, -0.002, 1e-9);
    EXPECT_NEAR(touchOf(swept, node(m_origin + Vec3{0.012, 0, 0}), 0.003).m_surface.m_gap, -0.001, 1e-9);
}

TEST_P(SweptDistance, TheOffsetIsKept)
{
    const SweptShape swept = sweep(m_sphere, m_origin, {100, 0, 0});
    const SweptContact contact = touchOf(swept, node(m_origin + Vec3{1, 0, 0}), 0.02);
    EXPECT_NEAR(contact.m_time, 0.97 / 100, 1e-6 * 0.97 / 100);
    EXPECT_NEAR(contact.m_surface.m_gap, 0.97, 1e-6);
    touchOf(swept, node(m_origin + Vec3{1, 0.0299, 0}), 0.02);
    EXPECT_FALSE(touches(swept, node(m_origin + Vec3{1, 0.0299, 0})));
}

TEST_P(SweptDistance, ANeedleMeetsTheMiddleOfATriangle)
{
    btCylinderShapeX needle(btVector3(btScalar(0.05), btScalar(0.001), btScalar(0.001)));
    const SweptShape swept = sweep(needle, m_origin, {20, 0, 0});
    const double x = 0.2, a = 0.05;  // edges of 5 cm, across the path
    const Vec3 middle = m_origin + Vec3{x, 0, 0};
    const double height = a * std::sqrt(0.75);
    const SweptFeature feature = triangle(middle + Vec3{0, -a / 2, -height / 3}, middle + Vec3{0, a / 2, -height / 3},
                                          middle + Vec3{0, 0, 2 * height / 3}, {-1, 0, 0});
    const SweptContact contact = touchOf(swept, feature);
    EXPECT_NEAR(contact.m_time, (x - 0.05) / 21, 1e-6 * (x - 0.05) / 21);
    EXPECT_NEAR(contact.m_surface.m_normal.x, 1, 1e-6);
    for (double w : contact.m_surface.m_barycentric) EXPECT_NEAR(w, 1.0 / 3, 0.03);  // any point of the flat end
    expectRowStopsAtTouch(swept, feature, contact);

    EXPECT_FALSE(touches(swept, node(feature.m_position[0])));
    EXPECT_FALSE(touches(swept, edge(feature.m_position[0], feature.m_position[1])));
    const Vec3 low = middle + Vec3{0, -a / 2, 0.0009}, high = middle + Vec3{0, a / 2, 0.0009};
    const SweptContact crossing = touchOf(swept, edge(low, high));
    EXPECT_NEAR(crossing.m_time, (x - 0.05) / 20, 1e-6 * (x - 0.05) / 20);
    EXPECT_NEAR(crossing.m_surface.m_barycentric[0], 0.5, 0.02);
    EXPECT_EQ(crossing.m_surface.m_barycentric[2], 0);
}

TEST_P(SweptDistance, AThinPlateStopsAFastNode)
{
    btBoxShape plate(btVector3(btScalar(0.5), btScalar(0.5), btScalar(0.001)));
    const SweptShape swept = sweep(plate, m_origin, {});
    const SweptFeature feature = node(m_origin + Vec3{0.1, 0.2, 0.4}, {0, 0, -50});
    const SweptContact contact = touchOf(swept, feature);
    EXPECT_NEAR(contact.m_time, 0.399 / 50, 1e-6 * 0.399 / 50);
    EXPECT_NEAR(contact.m_surface.m_gap, 0.399, 1e-6);
    EXPECT_EQ(contact.m_surface.m_normal.z, 1);
    EXPECT_FALSE(touches(swept, node(m_origin + Vec3{0.501, 0, 0.4}, {0, 0, -50})));
    const SweptContact slanted = touchOf(swept, node(m_origin + Vec3{-0.3, 0, 0.4}, {30, 0, -40}));
    EXPECT_NEAR(slanted.m_time, 0.399 / 40, 1e-6 * 0.399 / 40);
    EXPECT_EQ(slanted.m_surface.m_normal.z, 1);
}

TEST_P(SweptDistance, TheTipOfATurningRodHits)
{
    btCapsuleShapeX rod(btScalar(0.005), btScalar(0.6));
    const double spin = 30, touchAngle = 0.4;  // [rad/s], [rad]
    const SweptShape swept = sweep(rod, m_origin, {}, {0, 0, spin});
    // The side of the rod, of radius 5 mm, meets the node: at 0.29 m its line of contact leads the axis by asin(5 /
    // 290).
    const double radius = 0.29, lead = std::asin(double(rod.getRadius()) / radius);
    const SweptFeature feature =
        node(m_origin + radius * Vec3{std::cos(touchAngle + lead), std::sin(touchAngle + lead), 0});
    const SweptContact contact = touchOf(swept, feature);
    EXPECT_NEAR(contact.m_time, touchAngle / spin, 1e-6 * touchAngle / spin);
    const Vec3 normal = {-std::sin(touchAngle), std::cos(touchAngle), 0};
    EXPECT_NEAR(norm(contact.m_surface.m_normal - normal), 0, 1e-5);
    expectRowStopsAtTouch(swept, feature, contact);
    const SweptContact inner = touchOf(swept, node(m_origin + Vec3{0.02, 0.01, 0}));  // slow, near the axis of spin
    const double angle = std::atan2(0.01, 0.02) - std::asin(0.005 / std::hypot(0.01, 0.02));
    EXPECT_NEAR(inner.m_time, angle / spin, 1e-6 * angle / spin);
    EXPECT_FALSE(touches(swept, node(m_origin + 0.306 * Vec3{std::cos(touchAngle), std::sin(touchAngle), 0})));
    EXPECT_FALSE(touches(swept, node(m_origin + radius * Vec3{std::cos(0.6), std::sin(0.6), 0}))) << "too late";
    EXPECT_FALSE(touches(swept, node(m_origin + radius * Vec3{std::cos(0.1), -std::sin(0.1), 0}))) << "it parts";
}

TEST_P(SweptDistance, PlanesAreMetByTheFirstCorner)
{
    btStaticPlaneShape plane(btVector3(0, 0, 1), 0);
    const SweptShape swept = sweep(plane, m_origin, {0, 0, 1});
    SweptFeature feature = triangle(m_origin + Vec3{0, 0, 0.2}, m_origin + Vec3{1, 0, 0.3}, m_origin + Vec3{0, 1, 0.4});
    feature.m_velocity[2].z = -99;
    const SweptContact contact = touchOf(swept, feature);
    EXPECT_NEAR(contact.m_time, 0.004, 1e-6 * 0.004);
    EXPECT_EQ(contact.m_surface.m_barycentric[2], 1);
    EXPECT_FALSE(isFast(swept, 1e6, 1e-3)) << "its normal is the same everywhere";
    const SweptContact turned = touchOf(sweep(plane, m_origin, {}, {5, 0, 0}), node(m_origin + Vec3{0, 1, 0.06}));
    EXPECT_NEAR(turned.m_time, std::atan(0.06) / 5, 1e-6 * std::atan(0.06) / 5);
}

TEST_P(SweptDistance, BoundsHoldTheShapeOnAllOfItsWay)
{
    btBoxShape box(btVector3(btScalar(0.5), btScalar(0.1), btScalar(0.05)));
    RandomPoints random;
    for (int k = 0; k < 50; ++k)
    {
        const SweptShape swept = sweep(box, m_origin, 30 * random.inBox(1), 100 * random.inBox(1));
        for (int i = 0; i <= 20; ++i)
        {
            const Pose pose = swept.poseAt(i * kSweep / 20);
            for (int corner = 0; corner < 8; ++corner)
            {
                const Vec3 p =
                    pose.toWorld({corner & 1 ? 0.5 : -0.5, corner & 2 ? 0.1 : -0.1, corner & 4 ? 0.05 : -0.05});
                for (int c = 0; c < 3; ++c)
                {
                    EXPECT_LE(swept.m_boundsMin[c], p[c]);
                    EXPECT_GE(swept.m_boundsMax[c], p[c]);
                }
            }
        }
    }
}

TEST(SweptShape, TurnsAboutItsCentre)
{
    btSphereShape sphere(btScalar(0.5));
    ShapeLeaf leaf = leafOf(sphere);
    leaf.m_pose.m_origin = {3, 0, 0};
    const SweptShape swept(leaf, {{2, 0, 0}, {10, 0, 0}, {0, 0, 0.5 * M_PI / kSweep}}, kSweep);
    const Pose end = swept.poseAt(kSweep);  // after a quarter turn
    EXPECT_NEAR(norm(end.m_origin - Vec3{2 + 10 * kSweep, 1, 0}), 0, 1e-14);
    EXPECT_NEAR(norm(end.m_rotation * Vec3{1, 0, 0} - Vec3{0, 1, 0}), 0, 1e-14);
    EXPECT_NEAR(swept.m_spinRadius, 1, 1e-14) << "the sphere itself turns unseen";
}

TEST(SweptShape, MovedBackAndForthIsTheSame)
{
    btCapsuleShape capsule(btScalar(0.1), btScalar(0.5));
    RandomPoints random;
    for (int k = 0; k < 20; ++k)
    {
        const ShapeLeaf leaf = leafOf(capsule, random.placement(1));
        const RigidMotion present = {random.inBox(1), 50 * random.inBox(1), 50 * random.inBox(1)};
        const RigidMotion before = {present.m_center - kSweep * present.m_linearVelocity, present.m_linearVelocity,
                                    present.m_angularVelocity};
        const ShapeLeaf start = movedBack(leaf, present, kSweep);
        const Pose end = SweptShape(start, before, kSweep).poseAt(kSweep);
        EXPECT_NEAR(norm(end.m_origin - leaf.m_pose.m_origin), 0, 1e-13);
        EXPECT_NEAR(squaredNorm(end.m_rotation - leaf.m_pose.m_rotation), 0, 1e-26);
        for (int c = 0; c < 3; ++c)
        {
            EXPECT_LE(start.m_boundsMin[c], start.m_pose.m_origin[c] - 0.1);
            EXPECT_GE(start.m_boundsMax[c], start.m_pose.m_origin[c] + 0.1);
        }
    }
}

TEST(SweptShape, NodesFarFromThePathCannotMeetIt)
{
    btSphereShape sphere(btScalar(0.01));
    const SweptShape swept = sweep(sphere, {}, {60, 60, 0});  // 1 m along x and along y
    EXPECT_TRUE(mayMeet(swept, node({0.5, 0.5, 0}), 0));
    EXPECT_FALSE(mayMeet(swept, node({0.5, 0.55, 0}), 0)) << "within the bounds, but beside the path";
    EXPECT_TRUE(mayMeet(swept, node({0.5, 0.55, 0}), 0.03));
    EXPECT_FALSE(mayMeet(swept, node({1.1, 1.1, 0}), 0.03));
    EXPECT_TRUE(mayMeet(swept, edge({0.5, 0.45, 0}, {0.5, 0.55, 0}), 0));
    EXPECT_FALSE(mayMeet(swept, triangle({0.5, 0.45, 0.1}, {0.5, 0.55, 0.1}, {0.45, 0.5, 0.1}), 0));
    EXPECT_TRUE(mayMeet(swept, node({0.5, 0.5, 0.5}, {0, 0, -60}), 0)) << "it comes";
}

TEST(SweptShape, IsFastFromHalfAnEdgeOrThicknessAStep)
{
    btBoxShape box(btVector3(btScalar(0.5), btScalar(0.25), btScalar(0.125)));
    const SweptShape still = sweep(box, {}, {});
    EXPECT_FALSE(isFast(still, 0.99 * 0.05 / kSweep, 0.1));
    EXPECT_TRUE(isFast(still, 1.01 * 0.05 / kSweep, 0.1));
    EXPECT_FALSE(isFast(still, 0.99 * 0.125 / kSweep, 1));
    EXPECT_TRUE(isFast(still, 1.01 * 0.125 / kSweep, 1));
    EXPECT_FALSE(isFast(still, 0.99 * 0.2 / kSweep, 2)) << "thinner than a fifth of an edge";
    EXPECT_TRUE(isFast(still, 1.01 * 0.2 / kSweep, 2));
    const double radius = std::sqrt(0.3125);
    EXPECT_FALSE(isFast(sweep(box, {}, {}, {0, 0, 0.99 * 0.05 / radius / kSweep}), 0, 0.1));
    EXPECT_TRUE(isFast(sweep(box, {}, {}, {0, 0, 1.01 * 0.05 / radius / kSweep}), 0, 0.1));
}

// Twice the displacement by gravity in a step: bodies at rest stay below that.
TEST(SweptShape, FallsFarFromAQuarterOfAnEdgeOrThicknessAStep)
{
    btBoxShape box(btVector3(btScalar(0.5), btScalar(0.25), btScalar(0.125)));
    const SweptShape still = sweep(box, {}, {});
    const double square = kSweep * kSweep;
    EXPECT_FALSE(fallsFar(still, 0.99 * 0.025 / square, 0.1));
    EXPECT_TRUE(fallsFar(still, 1.01 * 0.025 / square, 0.1));
    EXPECT_FALSE(fallsFar(still, 0.99 * 0.0625 / square, 1));
    EXPECT_TRUE(fallsFar(still, 1.01 * 0.0625 / square, 1));
    btStaticPlaneShape plane(btVector3(0, 0, 1), 0);
    EXPECT_FALSE(fallsFar(sweep(plane, {}, {}), 1e6, 1e-3)) << "its normal is the same everywhere";
}

TEST(SweptShape, NonFiniteValuesMakeNoContact)
{
    btSphereShape sphere(btScalar(0.01));
    const SweptFeature good = node({1, 0, 0});
    EXPECT_TRUE(touches(sweep(sphere, {}, {100, 0, 0}), good));
    EXPECT_FALSE(touches(sweep(sphere, {}, {100, kNan, 0}), good));
    EXPECT_FALSE(touches(sweep(sphere, {}, {100, 0, 0}, {kNan, 0, 0}), good));
    EXPECT_FALSE(touches(sweep(sphere, {kNan, 0, 0}, {100, 0, 0}), good));
    EXPECT_FALSE(touches(sweep(sphere, {}, {100, 0, 0}), node({1, kNan, 0})));
    EXPECT_FALSE(touches(sweep(sphere, {}, {100, 0, 0}), node({1, 0, 0}, {0, 0, kNan})));
    EXPECT_FALSE(touches(sweep(sphere, {}, {1e300, 0, 0}), good));
    SweptFeature lame = triangle({1, -1, -1}, {1, 1, -1}, {1, 0, 1});
    EXPECT_TRUE(touches(sweep(sphere, {}, {100, 0, 0}), lame));
    lame.m_velocity[1].y = kNan;
    EXPECT_FALSE(touches(sweep(sphere, {}, {100, 0, 0}), lame));
    for (Vec3& x : lame.m_position) x.x = 0;
    EXPECT_FALSE(touches(sweep(sphere, {}, {100, 0, 0}), lame)) << "though it touches as the step begins";
}

namespace
{

/// Random shapes and features cross each other's paths; the oracle is dense sampling in time.
class SweptSolid : public ::testing::TestWithParam<NamedShape>
{
protected:
    static constexpr int kSamples = 1000;

    // A feature that moves roughly towards a place.
    SweptFeature randomFeature(const Vec3& target)
    {
        SweptFeature feature;
        feature.m_count = 1 + int(1.5 + 1.5 * m_random.inBox(1).x);
        feature.m_position = m_random.triangle(2, 0.7);
        const Vec3 way = target + m_random.inBox(1) - feature.m_position[0];
        for (Vec3& v : feature.m_velocity) v = (1.5 / kSweep) * (way + m_random.inBox(0.1));
        return feature;
    }

    double gapAt(const SweptShape& shape, const SweptFeature& feature, double time)
    {
        ShapeLeaf leaf = shape.m_leaf;
        leaf.m_pose = shape.poseAt(time);
        std::array<Vec3, 3> x;
        for (int i = 0; i < 3; ++i)
        {
            const int k = std::min(i, feature.m_count - 1);
            x[i] = feature.m_position[k] + time * feature.m_velocity[k];
        }
        SurfaceDistance d;
        EXPECT_TRUE(feature.m_count == 1 ? pointShapeDistance(leaf, x[0], 1e30, d)
                                         : triangleShapeDistance(leaf, x, 1e30, d));
        return d.m_gap;
    }

    // Time of first contact by sampling; negative if there is none.
    double sampled(const SweptShape& shape, const SweptFeature& feature)
    {
        double before = 0, touch = 0;
        while (touch <= kSweep && gapAt(shape, feature, touch) > 0)
        {
            before = touch;
            touch += kSweep / kSamples;
        }
        if (touch > kSweep) return -1;
        for (int k = 0; k < 60; ++k)
        {
            const double middle = 0.5 * (before + touch);
            (gapAt(shape, feature, middle) > 0 ? before : touch) = middle;
        }
        return touch;
    }

    RandomPoints m_random;
};

}  // namespace

INSTANTIATE_TEST_SUITE_P(, SweptSolid, ::testing::ValuesIn(convexSolids()), shapeName);

TEST_P(SweptSolid, FirstContactsMatchDenseSampling)
{
    const ShapePtr solid = GetParam().m_make();
    int touching = 0;
    for (int k = 0; k < 100; ++k)
    {
        SCOPED_TRACE(k);
        const ShapeLeaf leaf = leafOf(*solid, m_random.placement(1));
        const Vec3 spin = k % 2 == 1 ? 60 * m_random.inBox(0.5) : Vec3{};
        const RigidMotion motion = {leaf.m_pose.m_origin + m_random.inBox(0.3), 60 * m_random.inBox(0.5), spin};
        const SweptShape shape(leaf, motion, kSweep);
        const SweptFeature feature = randomFeature(leaf.m_pose.m_origin + kSweep / 2 * motion.m_linearVelocity);
        const double expected = sampled(shape, feature);
        SweptContact contact;
        contact.m_time = -1;
        EXPECT_GE(mayMeet(shape, feature, 0), expected >= 0);
        EXPECT_EQ(sweptDistance(shape, feature, 0, contact), expected >= 0);
        EXPECT_NEAR(contact.m_time, expected, 1e-6 * std::fabs(expected));
        touching += contact.m_time > 0;
    }
    EXPECT_GT(touching, 25);
    EXPECT_LT(touching, 75);
}

}  // namespace bullet_fem

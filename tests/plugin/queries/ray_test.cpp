// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// Ray tests against FEM bodies.
#include <gtest/gtest.h>

#include <functional>

#include "BulletSoftBody/btSoftBodyHelpers.h"
#include "bullet_fem/btFemHelpers.h"
#include "bullet_fem/btFemRay.h"
#include "bullet_fem/btFemVectors.h"
#include "bullet_fem/fem/mesh/generators.h"
#include "plugin/scenes/each_world.h"
#include "plugin/scenes/random_rays.h"
#include "plugin/scenes/scene_measures.h"
#include "plugin/scenes/soft_boxes.h"

namespace bullet_fem
{
namespace
{

struct Scene
{
    explicit Scene(WorldClass worldClass = WorldClass::softRigid) : m_world(worldClass), m_fem(m_world.fem()) {}
    FemWorld m_world;
    btFemSoftBodySolver& m_fem;
};

using Maker = std::function<btSoftBody*(Scene&)>;

btSoftBody* blockOf(Scene& scene, const Vec3& center)
{
    SoftBox box;
    box.m_center = center;
    box.m_youngModulus = btScalar(3e4);
    return makeSoftBox(scene.m_world, scene.m_fem, box);
}

btSoftBody* block(Scene& scene)
{
    return blockOf(scene, {0, 0, 0.5});
}

btSoftBody* twoPieces(Scene& scene)
{
    const TetMesh a = makeBox({1, 1, 1}, {3, 3, 3});
    std::vector<Vec3> X = a.restPositions();
    std::vector<Tet> tets = a.tets();
    const int n = a.nodeCount();
    for (int i = 0; i < n; ++i) X.push_back(X[i] + Vec3{1.7, 0.3, 0.2});
    for (int e = 0; e < a.tetCount(); ++e)
        tets.push_back({tets[e][0] + n, tets[e][1] + n, tets[e][2] + n, tets[e][3] + n});
    return btFemHelpers::createFromTetMesh(scene.m_world.info(), TetMesh(X, tets));
}

btSoftBody* cage(Scene& scene)
{
    SurfaceMesh octahedron;
    octahedron.m_vertices = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
    octahedron.m_triangles = {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4}, {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}};
    CageSettings settings;
    settings.m_cellSize = 0.25;
    return btFemHelpers::createFromSurface(scene.m_world.info(), octahedron, settings);
}

// Bodies assembled as in Panda3D and others: node by node, with or without links and faces.
btSoftBody* assembled(Scene& scene, bool links, bool faces)
{
    const TetMesh mesh = makeBox({1, 1, 1}, {3, 3, 3});
    auto* body = new btSoftBody(&scene.m_world.info());
    body->appendMaterial()->m_kLST = 1;
    for (const Vec3& X : mesh.restPositions()) body->appendNode(bulletVector(X), 15);
    for (const Tet& tet : mesh.tets()) body->appendTetra(tet[0], tet[1], tet[2], tet[3]);
    for (const Tet& tet : mesh.tets())
        for (int a = 0; links && a < 4; ++a)
            for (int b = 0; b < a; ++b) body->appendLink(tet[a], tet[b], nullptr, true);
    for (const Triangle& t : mesh.surface())
        if (faces) body->appendFace(t[0], t[1], t[2]);
    return body;
}

struct RayCase
{
    const char* m_name;
    Maker m_make;
    bool m_ordered;  // true: the order of faces and tetrahedra makes Bullet report a face
};

class RayTestOfAFemBody : public EachWorldWith<RayCase>
{
protected:
    RayTestOfAFemBody() : m_scene(worldClass()), m_body(m_scene.m_world.addSoft(value().m_make(m_scene)))
    {
        m_scene.m_world.addPlane(btScalar(-1.2));
    }

    // Compares Bullet's rayTest and btFem's with brute force.
    void compare()
    {
        const int count = worldClass() == WorldClass::softRigid ? kRays : kRays / 4;
        Rays rays(m_body);
        int hits = 0, unclear = 0, beside = 0, asTets = 0, wrong = 0;
        for (int k = 0; k < count; ++k)
        {
            btVector3 from, to;
            rays.next(from, to);
            const RayReference reference = bruteForce(m_body, vec3(from), vec3(to));
            compareOurs(reference, from, to);
            btSoftBody::sRayCast found;
            const bool hit = m_body.rayTest(from, to, found);
            unclear += reference.m_face >= 0 && !reference.isClear();
            beside += reference.m_face < 0 && hit;
            if (!reference.isClear()) continue;
            ++hits;
            ASSERT_TRUE(hit) << "ray " << k;
            ASSERT_EQ(found.body, &m_body);
            const bool tet = found.feature == btSoftBody::eFeature::Tetra;
            const double error = std::fabs(found.fraction - reference.m_fraction);
            asTets += tet;
            // A tetrahedron's face that is parallel to the ray may be found before the surface, by rounding.
            const bool early = tet && found.fraction < reference.m_fraction;
            wrong += early && error > reference.tolerance(vec3(from), vec3(to));
            ASSERT_TRUE(early || error < reference.tolerance(vec3(from), vec3(to))) << "ray " << k << ", " << error;
            ASSERT_TRUE(tet || found.index == reference.m_face) << "ray " << k;
        }
        EXPECT_GT(hits, count / 4);
        EXPECT_LT(unclear, hits / 2);
        EXPECT_LT(beside, count / 100);  // within Bullet's tolerance
        EXPECT_LE(wrong, hits / 1000);
        EXPECT_LE(asTets, value().m_ordered ? hits / 1000 : hits);
        RecordProperty("hits", hits);
        RecordProperty("asTets", asTets);
    }

    void compareOurs(const RayReference& reference, const btVector3& from, const btVector3& to)
    {
        btFemRayHit hit;
        const bool hits = btFemRay::test(&m_body, from, to, &hit);
        const bool onEdge = reference.m_face >= 0 && reference.m_smallest < 1e-9;
        m_onEdges += onEdge;
        if (onEdge) return;
        ASSERT_EQ(hits, reference.m_face >= 0);
        if (!hits) return;
        ASSERT_EQ(hit.m_face, reference.m_face);
        ASSERT_NEAR(hit.m_fraction, reference.m_fraction, 1e-7);
        ASSERT_LT(hit.m_normal.dot(to - from), 0);
        btVector3 point(0, 0, 0);
        for (int a = 0; a < 3; ++a) point += hit.m_weights[a] * m_body.m_nodes[hit.m_nodes[a]].m_x;
        ASSERT_LT(point.distance(hit.m_point), 1e-5);
    }

    Scene m_scene;
    btSoftBody& m_body;
    int m_onEdges = 0;
};

TEST_P(RayTestOfAFemBody, MatchesBruteForceAtRestInMotionAndFarAway)
{
    m_scene.m_fem.prepare(&m_body, kStep);
    compare();
    m_scene.m_world.step(40);
    m_body.translate(btVector3(0, 0, 3));
    m_body.rotate(btQuaternion(btVector3(1, 2, 3).normalized(), btScalar(1.1)));
    m_scene.m_world.step(10);
    m_body.translate(btVector3(3, -2, 1));  // not stepped yet
    compare();
    EXPECT_LT(m_onEdges, kRays / 1000);
}

const RayCase kRayCases[] = {
    {"Block", block, true},
    {"TwoPieces", twoPieces, true},
    {"Cage", cage, true},
    {"WithLinks", [](Scene& scene) { return assembled(scene, true, true); }, false},
    {"WithoutLinks", [](Scene& scene) { return assembled(scene, false, true); }, false},
};

std::string rayName(const RayCase& ray)
{
    return ray.m_name;
}

INSTANTIATE_TEST_SUITE_P(Bodies, RayTestOfAFemBody,
                         testing::Combine(testing::Values(WorldClass::softRigid), testing::ValuesIn(kRayCases)),
                         nameOfWorldWith(rayName));
INSTANTIATE_TEST_SUITE_P(OtherWorlds, RayTestOfAFemBody,
                         testing::Combine(testing::Values(WorldClass::softMultiBody, WorldClass::deformable),
                                          testing::Values(kRayCases[0])),
                         nameOfWorldWith(rayName));

class RayTestTermination : public EachWorld
{
};

INSTANTIATE_TEST_SUITE_P(Worlds, RayTestTermination, eachWorld(), nameOfWorld);

// Bullet's own tree never terminates for unconnected faces or nodes.
TEST_P(RayTestTermination, HoldsForAnyChangeOfFaces)
{
    Scene scene(GetParam());
    btSoftBody& body = scene.m_world.addSoft(assembled(scene, false, true));
    btSoftBody::sRayCast found;
    const btVector3 from(btScalar(0.4), btScalar(0.3), 3), to(btScalar(0.4), btScalar(0.3), -30);
    scene.m_fem.prepare(&body, kStep);
    EXPECT_TRUE(body.rayTest(from, to, found));
    scene.m_world.step();
    for (int k = 0; k < 40; ++k) body.appendFace(0, 1, 2);  // reallocates the faces
    scene.m_world.step();
    EXPECT_TRUE(body.rayTest(from, to, found));
    EXPECT_TRUE(body.rayFaceTest(from, to, found));
    body.m_fdbvt.clear();
    scene.m_world.step();
    EXPECT_FALSE(body.m_fdbvt.empty());
    EXPECT_TRUE(body.rayTest(from, to, found));
    body.m_faces.clear();
    scene.m_world.step();
    EXPECT_TRUE(body.m_fdbvt.empty());
    EXPECT_TRUE(body.rayTest(from, to, found));
    EXPECT_EQ(found.feature, btSoftBody::eFeature::Tetra);
}

TEST_P(RayTestTermination, HoldsForARejectedBody)
{
    Scene scene(GetParam());
    btSoftBody& body = scene.m_world.addSoft(assembled(scene, false, true));
    scene.m_fem.prepare(&body, kStep);
    body.appendTetra(0, 0, 1, 2);
    scene.m_world.step(3);
    ASSERT_FALSE(scene.m_fem.isFem(&body));
    btSoftBody::sRayCast found;
    const Vec3 center = centerOf(body);
    EXPECT_TRUE(body.rayTest(bulletVector(center + Vec3{0.1, 0.05, 3}), bulletVector(center), found));
}

TEST(RayTestOfABodyWithoutFaces, FindsTheSidesOfItsTetrahedra)
{
    Scene scene;
    btSoftBody& bare = scene.m_world.addSoft(assembled(scene, false, false));
    btSoftBody* faced = assembled(scene, false, true);
    scene.m_world.addSoft(faced);
    Rays rays(bare);
    int hits = 0;
    for (int k = 0; k < kRays; ++k)
    {
        btVector3 from, to;
        rays.next(from, to);
        btFemRayHit a, b;
        ASSERT_EQ(btFemRay::test(&bare, from, to, &a), btFemRay::test(faced, from, to, &b));
        ASSERT_NEAR(a.m_fraction, b.m_fraction, 1e-6);
        ASSERT_EQ(a.m_face, -1);
        hits += b.m_face >= 0;
    }
    EXPECT_GT(hits, kRays / 4);
}

TEST(BadRays, HitNothing)
{
    Scene scene;
    btSoftBody& body = scene.m_world.addSoft(block(scene));
    const btVector3 far(0, 0, 5), deep(0, 0, -5), broken(0, NAN, 0);
    EXPECT_FALSE(btFemRay::test(nullptr, far, deep));
    EXPECT_FALSE(btFemRay::test(&body, far, far));
    EXPECT_FALSE(btFemRay::test(&body, far, broken));
    EXPECT_FALSE(btFemRay::test(&body, broken, deep));
    EXPECT_TRUE(btFemRay::test(&body, far, deep));
}

}  // namespace
}  // namespace bullet_fem

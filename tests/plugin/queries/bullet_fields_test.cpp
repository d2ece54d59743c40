// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// Fields of btSoftBody and btCollisionObject that programs read or write: render nodes, user data, activation,
// collision flags and filters, the world info, aerodynamics.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "BulletSoftBody/btSoftBodyHelpers.h"
#include "bullet_fem/btFemHelpers.h"
#include "bullet_fem/btFemVectors.h"
#include "bullet_fem/fem/mesh/generators.h"
#include "plugin/scenes/each_world.h"
#include "plugin/scenes/scene_measures.h"
#include "plugin/scenes/soft_boxes.h"

namespace bullet_fem
{
namespace
{

// A cube of 1 m above a floor, in cells of 0.25 m.
class BulletFields : public EachWorld
{
protected:
    static SoftBox cube()
    {
        SoftBox box;
        box.m_center = {0, 0, 0.5};
        return box;
    }

    bool fallsFreely()
    {
        m_body.setVelocity(btVector3(0, 0, 0));
        m_world.step(20);
        return velocityOf(m_body).z < -0.95 * kGravity * 20 * double(kStep);
    }

    FemWorld m_world{GetParam()};
    btFemSoftBodySolver& m_fem = m_world.fem();
    btRigidBody& m_floor = m_world.addFloorBox();
    btSoftBody& m_body = addSoftBox(m_world, m_fem, cube());
};

INSTANTIATE_TEST_SUITE_P(Worlds, BulletFields, eachWorld(), nameOfWorld);

class RenderNodes : public BulletFields
{
protected:
    RenderNodes()
    {
        for (const Vec3& x : {Vec3{0.1, 0.2, 0.3}, Vec3{-0.4, 0.1, 0.9}, Vec3{0.3, -0.3, 0.55}, Vec3{0, 0, 1.2}})
        {
            btSoftBody::RenderNode node;
            node.m_x = bulletVector(x);
            m_body.m_renderNodes.push_back(node);
            m_start.push_back(node.m_x);
        }
    }

    std::vector<btVector3> m_start;
};

INSTANTIATE_TEST_SUITE_P(Worlds, RenderNodes, eachWorld(), nameOfWorld);

TEST_P(RenderNodes, FollowTheirTetrahedraByInterpolation)
{
    btSoftBodyHelpers::interpolateBarycentricWeights(&m_body);
    m_world.step();
    for (int v = 0; v < m_body.m_renderNodes.size(); ++v)
        EXPECT_LT(m_body.m_renderNodes[v].m_x.distance(m_start[v]), 1e-2);
    m_body.translate(btVector3(1, 2, 3));
    m_body.rotate(btQuaternion(btVector3(0, 0, 1), btScalar(0.7)));
    for (int k = 0; k < 30; ++k)
    {
        m_world.step();
        for (int v = 0; v < m_body.m_renderNodes.size(); ++v)
        {
            btVector3 x(0, 0, 0);
            for (int a = 0; a < 4; ++a)
                x += m_body.m_renderNodesInterpolationWeights[v][a] * m_body.m_renderNodesParents[v][a]->m_x;
            ASSERT_LT(m_body.m_renderNodes[v].m_x.distance(x), 1e-5);
            ASSERT_GT(m_body.m_renderNodes[v].m_x.distance(m_start[v]), 1);
        }
    }
}

// Bullet's transform does not move them.
TEST_P(RenderNodes, WaitForTheStepAfterATransformUnlessTheyAreUpdated)
{
    btSoftBodyHelpers::interpolateBarycentricWeights(&m_body);
    const btTransform pose(btQuaternion(btVector3(0, 0, 1), btScalar(0.7)), btVector3(1, 2, 3));
    m_body.transform(pose);
    for (int v = 0; v < m_body.m_renderNodes.size(); ++v) EXPECT_EQ(m_body.m_renderNodes[v].m_x, m_start[v]);
    btFemHelpers::updateEmbeddedSurface(&m_body);
    for (int v = 0; v < m_body.m_renderNodes.size(); ++v)
        EXPECT_LT(m_body.m_renderNodes[v].m_x.distance(pose * m_start[v]), 1e-5);
}

TEST_P(RenderNodes, KeepTheirFaceDistanceByExtrapolation)
{
    btSoftBodyHelpers::extrapolateBarycentricWeights(&m_body);
    m_world.step();
    m_body.translate(btVector3(1, 2, 3));
    m_world.step();
    for (int v = 0; v < m_body.m_renderNodes.size(); ++v)
        EXPECT_LT(m_body.m_renderNodes[v].m_x.distance(m_start[v] + btVector3(1, 2, 3)), 2e-2);
}

// btSoftMultiBodyDynamicsWorld itself reads the weights of all soft bodies, for any solver.
class RenderNodesAlone : public RenderNodes
{
};

INSTANTIATE_TEST_SUITE_P(Worlds, RenderNodesAlone, testing::Values(WorldClass::softRigid, WorldClass::deformable),
                         nameOfWorld);

TEST_P(RenderNodesAlone, StayInPlaceWithoutWeightsOrParents)
{
    const auto expectStill = [this]
    {
        m_world.step(2);
        for (int v = 0; v < m_body.m_renderNodes.size(); ++v) EXPECT_EQ(m_body.m_renderNodes[v].m_x, m_start[v]);
    };
    expectStill();  // nothing but nodes
    m_body.m_renderNodesParents.resize(m_body.m_renderNodes.size());
    expectStill();
    m_body.m_renderNodesParents.resize(0);
    m_body.m_renderNodesInterpolationWeights.resize(m_body.m_renderNodes.size());
    expectStill();
    m_body.m_renderNodesParents.resize(m_body.m_renderNodes.size());
    m_body.m_renderNodesParents[2].push_back(&m_body.m_nodes[0]);  // too few entries
    expectStill();
    m_body.m_z.resize(2);
    expectStill();
    btSoftBodyHelpers::interpolateBarycentricWeights(&m_body);
    btSoftBody::RenderNode later;
    later.m_x = btVector3(9, 9, 9);
    m_start.push_back(later.m_x);
    m_body.m_renderNodes.push_back(later);  // has no weights yet
    m_world.step(2);
    EXPECT_EQ(m_body.m_renderNodes[4].m_x, later.m_x);
}

TEST_P(BulletFields, GenerateBoundaryFacesMakesTheFacesOfTheSurface)
{
    const int faces = m_body.m_faces.size();
    m_world.step();
    m_body.m_faces.clear();
    btSoftBodyHelpers::generateBoundaryFaces(&m_body);
    EXPECT_EQ(m_body.m_faces.size(), faces);
    m_world.step(5);
    EXPECT_TRUE(allFinite(m_body));
    btSoftBody::sRayCast hit;
    EXPECT_TRUE(m_body.rayTest(btVector3(btScalar(0.1), btScalar(0.07), 4), btVector3(btScalar(0.1), 0, -4), hit));
    EXPECT_GT(m_body.m_rcontacts.size(), 0);
}

// Bullet's world has no sweep tests against soft bodies: the object behind is hit.
TEST_P(BulletFields, ConvexSweepTestPassesFemBodiesAsItPassesBulletsSoftBodies)
{
    m_world.step();
    btSphereShape sphere(btScalar(0.2));
    const btTransform from = at(0, 0, 4), to = at(0, 0, -4);
    btCollisionWorld::ClosestConvexResultCallback sweep(from.getOrigin(), to.getOrigin());
    m_world.bullet().convexSweepTest(&sphere, from, to, sweep);
    ASSERT_TRUE(sweep.hasHit());
    EXPECT_EQ(sweep.m_hitCollisionObject, &m_floor);
    EXPECT_NEAR(sweep.m_closestHitFraction, 3.8 / 8, 1e-2);
}

TEST_P(BulletFields, CheckContactTellsDistanceAndNormalOfARigidBodyAtAnyPoint)
{
    m_world.info().m_sparsesdf.Initialize();
    RigidSettings settings;
    settings.m_transform = at(4, 0, 0);
    btRigidBody& box = addRigidBox(m_world, {2, 2, 2}, settings);
    m_world.step(10);
    const btCollisionObjectWrapper wrapper(nullptr, box.getCollisionShape(), &box, box.getWorldTransform(), -1, -1);
    btSoftBody::sCti touch;
    EXPECT_TRUE(m_body.checkContact(&wrapper, btVector3(btScalar(2.98), 0, 0), btScalar(0.1), touch));
    EXPECT_EQ(touch.m_colObj, &box);
    EXPECT_NEAR(touch.m_normal.x(), -1, 1e-3);
    EXPECT_NEAR(touch.m_offset, 3, 0.125);  // half a cell of Bullet's field
    EXPECT_FALSE(m_body.checkContact(&wrapper, btVector3(btScalar(2.5), 0, 0), btScalar(0.1), touch));
}

// User indices and pointers of bodies and their parts, as numbers.
class UserData
{
public:
    explicit UserData(btSoftBody& body) : m_body(body)
    {
        body.setUserPointer(mark(1));
        body.setUserIndex(21);
        body.setUserIndex2(22);
        body.setUserIndex3(23);
        body.m_tag = mark(2);
        forEachTag([](void*& tag, int k) { tag = mark(100 + k); });
    }

    void expectUntouched()
    {
        EXPECT_EQ(m_body.getUserPointer(), mark(1));
        EXPECT_EQ(m_body.getUserIndex(), 21);
        EXPECT_EQ(m_body.getUserIndex2(), 22);
        EXPECT_EQ(m_body.getUserIndex3(), 23);
        EXPECT_EQ(m_body.m_tag, mark(2));
        int changed = 0;
        forEachTag([&changed](void*& tag, int k) { changed += tag != mark(100 + k); });
        EXPECT_EQ(changed, 0);
    }

private:
    static void* mark(int k) { return reinterpret_cast<void*>(static_cast<std::intptr_t>(16 * k)); }

    void forEachTag(const std::function<void(void*&, int)>& visit)
    {
        int k = 0;
        for (int i = 0; i < m_body.m_nodes.size(); ++i) visit(m_body.m_nodes[i].m_tag, k++);
        for (int i = 0; i < m_body.m_faces.size(); ++i) visit(m_body.m_faces[i].m_tag, k++);
        for (int i = 0; i < m_body.m_tetras.size(); ++i) visit(m_body.m_tetras[i].m_tag, k++);
        for (int i = 0; i < m_body.m_materials.size(); ++i) visit(m_body.m_materials[i]->m_tag, k++);
    }

    btSoftBody& m_body;
};

TEST_P(BulletFields, UserPointersIndicesAndTagsAreNeverModified)
{
    UserData data(m_body);
    m_body.forceActivationState(ACTIVE_TAG);
    m_world.step(300);
    ASSERT_EQ(m_body.getActivationState(), ISLAND_SLEEPING);
    data.expectUntouched();
    m_world.take(m_body);
    m_world.step(10);
    data.expectUntouched();
    m_world.put(m_body);
    m_body.activate(true);  // as a rigid body that is put back asleep
    m_fem.setMaterial(&m_body, btFemMaterial::rubber());
    m_body.translate(btVector3(0, 0, 1));
    m_world.step(290);
    data.expectUntouched();
    EXPECT_TRUE(m_fem.isFem(&m_body));
}

TEST_P(BulletFields, ActivateWakesASleeperAndForcedStatesAreKept)
{
    m_body.forceActivationState(ACTIVE_TAG);
    m_world.step(300);
    ASSERT_EQ(m_body.getActivationState(), ISLAND_SLEEPING);
    m_body.activate(true);
    m_world.step();
    EXPECT_EQ(m_body.getActivationState(), ACTIVE_TAG);
    m_world.step(60);
    EXPECT_TRUE(m_body.isActive());  // at rest, but not for long enough
    m_world.step(120);
    EXPECT_EQ(m_body.getActivationState(), ISLAND_SLEEPING);
    m_body.setActivationState(DISABLE_DEACTIVATION);
    m_world.step(200);
    EXPECT_EQ(m_body.getActivationState(), DISABLE_DEACTIVATION);
    m_body.setActivationState(ACTIVE_TAG);  // only a forced change leaves a DISABLE_ state in Bullet
    EXPECT_EQ(m_body.getActivationState(), DISABLE_DEACTIVATION);
    m_body.forceActivationState(DISABLE_SIMULATION);
    const std::vector<btScalar> before = bitsOf(m_body);
    m_world.step(30);
    EXPECT_EQ(bitsOf(m_body), before);
}

TEST_P(BulletFields, NoContactResponseOfTheSoftBodyMakesItAGhost)
{
    m_body.setCollisionFlags(m_body.getCollisionFlags() | btCollisionObject::CF_NO_CONTACT_RESPONSE);
    EXPECT_TRUE(fallsFreely());
    EXPECT_EQ(m_fem.contacts(&m_body).size(), 0);
}

TEST_P(BulletFields, CollisionFiltersDecideContacts)
{
    constexpr int kSoft = 64;
    m_world.step(30);
    EXPECT_GT(m_fem.contacts(&m_body).size(), 0);
    m_world.take(m_body);
    m_world.put(m_body, kSoft, btBroadphaseProxy::AllFilter & ~btBroadphaseProxy::StaticFilter);
    EXPECT_TRUE(fallsFreely());
    m_body.translate(btVector3(0, 0, 3));
    m_world.take(m_body);
    m_world.put(m_body, kSoft, btBroadphaseProxy::AllFilter);
    m_body.setVelocity(btVector3(0, 0, 0));
    m_world.step(120);
    EXPECT_GT(m_fem.contacts(&m_body).size(), 0);
    EXPECT_GT(centerOf(m_body).z, 0);
}

TEST_P(BulletFields, IgnoredObjectsMakeNoContact)
{
    m_body.setIgnoreCollisionCheck(&m_floor, true);
    EXPECT_TRUE(fallsFreely());
}

class UserMadeWorldInfo : public EachWorld
{
};

INSTANTIATE_TEST_SUITE_P(Worlds, UserMadeWorldInfo, eachWorld(), nameOfWorld);

// A body with its own world info: its gravity applies; dispatcher and broadphase need not be set for contact.
TEST_P(UserMadeWorldInfo, WorksWithNothingButGravity)
{
    FemWorld world(GetParam());
    world.setSoftGravity(btVector3(0, 0, btScalar(-1.62)));  // gravity of a deformable world, not of the body
    world.addFloorBox();
    btSoftBodyWorldInfo info;
    info.m_gravity = btVector3(0, 0, btScalar(-1.62));
    btSoftBody& body = world.addSoft(btFemHelpers::createBox(
        info, btVector3(0, 0, 1), btVector3(btScalar(0.25), btScalar(0.25), btScalar(0.25)), btScalar(0.125)));
    world.step(30);
    EXPECT_NEAR(velocityOf(body).z, -1.62 * 30 * double(kStep), 1e-4);
    world.step(300);
    EXPECT_NEAR(lowestHeight(body), 0, 1e-2);
    EXPECT_GT(body.m_rcontacts.size(), 0);
    world.deleteSoft(body);  // before its world info
}

// Engines delete the world info together with the world.
TEST_P(BulletFields, AWorldInfoOfNullOffWorldIsTolerated)
{
    m_world.step(10);
    m_world.take(m_body);
    m_body.m_worldInfo = nullptr;
    m_fem.setMaterial(&m_body, btFemMaterial::rubber());
    m_fem.prepare(&m_body, kStep);
    m_world.step(10);
    EXPECT_TRUE(btFemSoftBodySolver::valid(&m_body));
    m_body.m_worldInfo = &m_world.info();
    m_world.put(m_body);
    m_world.step(60);
    EXPECT_TRUE(m_fem.isFem(&m_body));
    EXPECT_GT(m_fem.contacts(&m_body).size(), 0);
}

TEST_P(BulletFields, AddAeroForceToNodeAndFaceActOnce)
{
    m_world.setSoftGravity(btVector3(0, 0, 0));
    m_body.translate(btVector3(0, 0, 3));
    m_body.m_cfg.aeromodel = btSoftBody::eAeroModel::V_TwoSided;
    m_body.setVelocity(btVector3(0, 0, btScalar(0.5)));
    m_world.step();
    const Vec3 before = motionOf(m_body).m_linear;
    m_body.m_cfg.kDG = btScalar(0.05);
    Vec3 sum;
    for (int i = 0; i < m_body.m_nodes.size(); ++i)
        m_body.addAeroForceToNode(btVector3(2, 0, 0), i), sum += vec3(m_body.m_nodes[i].m_f);
    m_body.m_cfg.kDG = 0;  // no force from the step itself
    ASSERT_GT(norm(sum), 1e-2);
    m_world.step();
    EXPECT_LT(norm(motionOf(m_body).m_linear - before - double(kStep) * sum), 1e-2 * double(kStep) * norm(sum) + 2e-4);
    const Vec3 after = motionOf(m_body).m_linear;
    m_world.step();
    EXPECT_LT(norm(motionOf(m_body).m_linear - after), 2e-4);

    m_body.m_cfg.aeromodel = btSoftBody::eAeroModel::F_TwoSided;
    m_body.m_cfg.kDG = btScalar(0.05);
    for (int f = 0; f < m_body.m_faces.size(); ++f) m_body.addAeroForceToFace(btVector3(2, 0, 0), f);
    Vec3 faces;
    for (int i = 0; i < m_body.m_nodes.size(); ++i) faces += vec3(m_body.m_nodes[i].m_f);
    m_body.m_cfg.kDG = 0;
    ASSERT_GT(norm(faces), 1e-2);
    m_world.step();
    EXPECT_LT(norm(motionOf(m_body).m_linear - after - double(kStep) * faces),
              1e-2 * double(kStep) * norm(faces) + 2e-4);
}

}  // namespace
}  // namespace bullet_fem

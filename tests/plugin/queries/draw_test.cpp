// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// Drawing of FEM bodies, by Bullet and by btFemDebugDraw, and contacts in Bullet's arrays.
#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "BulletSoftBody/btSoftBodyHelpers.h"
#include "bullet_fem/btFemDebugDraw.h"
#include "bullet_fem/btFemVectors.h"
#include "bullet_fem/fem/mesh/generators.h"
#include "plugin/scenes/each_world.h"
#include "plugin/scenes/scene_measures.h"
#include "plugin/scenes/soft_boxes.h"

namespace bullet_fem
{
namespace
{

struct Line
{
    btVector3 m_from, m_to, m_color;
    btScalar length() const { return m_from.distance(m_to); }
};

// Records the drawn primitives.
class Recorder : public btIDebugDraw
{
public:
    void drawLine(const btVector3& from, const btVector3& to, const btVector3& color) override
    {
        m_lines.push_back({from, to, color});
    }
    void drawContactPoint(const btVector3&, const btVector3&, btScalar, int, const btVector3&) override {}
    void reportErrorWarning(const char*) override {}
    void draw3dText(const btVector3&, const char*) override {}
    void setDebugMode(int mode) override { m_mode = mode; }
    int getDebugMode() const override { return m_mode; }

    std::vector<Line> ofColor(const btVector3& color) const
    {
        std::vector<Line> lines;
        for (const Line& line : m_lines)
            if (line.m_color == color) lines.push_back(line);
        return lines;
    }
    bool allFinite() const
    {
        return std::all_of(m_lines.begin(), m_lines.end(),
                           [](const Line& line) { return isFinite(vec3(line.m_from)) && isFinite(vec3(line.m_to)); });
    }

    std::vector<Line> m_lines;
    int m_mode = DBG_DrawWireframe;
};

// A cube at rest on a floor.
class Drawing : public EachWorld
{
protected:
    Drawing()
    {
        m_body.m_cfg.kDP = btScalar(0.1);
        m_world.step(200);
    }

    Recorder drawn(int modes, const btFemDrawSettings& settings = {}) const
    {
        Recorder recorder;
        btFemDebugDraw::draw(m_fem, &m_body, &recorder, modes, settings);
        return recorder;
    }

    static SoftBox cube()
    {
        SoftBox box;
        box.m_center = {0, 0, 0.5};
        return box;
    }

    FemWorld m_world{GetParam()};
    btFemSoftBodySolver& m_fem = m_world.fem();
    btRigidBody& m_floor = m_world.addFloorBox();
    btSoftBody& m_body = addSoftBox(m_world, m_fem, cube());
};

INSTANTIATE_TEST_SUITE_P(Worlds, Drawing, eachWorld(), nameOfWorld);

TEST_P(Drawing, ElementsAreTheSixEdgesOfEveryTetrahedronShrunk)
{
    btFemDrawSettings settings;
    settings.m_shrink = btScalar(0.5);
    const Recorder recorder = drawn(BT_FEM_DRAW_ELEMENTS, settings);
    ASSERT_EQ(recorder.m_lines.size(), 6u * m_body.m_tetras.size());
    double drawnLength = 0, length = 0;
    for (const Line& line : recorder.m_lines) drawnLength += line.length();
    for (int e = 0; e < m_body.m_tetras.size(); ++e)
        for (int a = 0; a < 4; ++a)
            for (int b = 0; b < a; ++b)
                length += m_body.m_tetras[e].m_n[a]->m_x.distance(m_body.m_tetras[e].m_n[b]->m_x);
    EXPECT_NEAR(drawnLength, 0.5 * length, 1e-5 * length);
    EXPECT_EQ(recorder.m_lines[0].m_color, settings.m_elementColor);
}

// The rest shape of a deformed and rotated body is drawn with its own size, at the body's place.
TEST_P(Drawing, StressFreeIsTheRestShapeInTheBodysPlace)
{
    const btQuaternion turn(btVector3(1, 2, 3).normalized(), btScalar(2.5));
    const btVector3 place(3, -4, 5);
    const std::vector<Vec3> rest = makeBox({1, 1, 1}, {4, 4, 4}).restPositions();
    for (int i = 0; i < m_body.m_nodes.size(); ++i)
    {
        const btVector3 X = bulletVector(rest[i] - Vec3{0.5, 0.5, 0.5});
        m_body.m_nodes[i].m_x =
            place + quatRotate(turn, btVector3(X.x() * btScalar(0.8), X.y(), X.z() * btScalar(1.1)));
    }
    const Recorder recorder = drawn(BT_FEM_DRAW_STRESS_FREE);
    const std::size_t triangles = m_body.m_faces.size();
    ASSERT_EQ(recorder.m_lines.size(), triangles * 3 / 2);  // each edge once
    std::set<std::array<int, 3>> corners;
    for (const Line& line : recorder.m_lines)
        for (const btVector3& end : {line.m_from, line.m_to})
        {
            const btVector3 X = quatRotate(turn.inverse(), end - place);
            for (int c = 0; c < 3; ++c) ASSERT_LT(std::fabs(X[c]), 0.505);
            corners.insert({int(std::lround(X.x() * 4)), int(std::lround(X.y() * 4)), int(std::lround(X.z() * 4))});
            ASSERT_NEAR(X.x() * 4, std::round(X.x() * 4), 0.02);
        }
    EXPECT_EQ(corners.size(), 98u);  // surface nodes of 4 x 4 x 4 cells
}

TEST_P(Drawing, ContactsArePointsNormalsAndImpulsesToScale)
{
    btFemDrawSettings settings;
    settings.m_pointSize = btScalar(0.03);
    settings.m_normalLength = btScalar(0.2);
    settings.m_impulseScale = btScalar(0.01);
    const auto& contacts = m_fem.contacts(&m_body);
    ASSERT_GT(contacts.size(), 3);
    const Recorder recorder = drawn(BT_FEM_DRAW_CONTACTS, settings);
    const std::vector<Line> crosses = recorder.ofColor(settings.m_pointColor);
    const std::vector<Line> normals = recorder.ofColor(settings.m_normalColor);
    const std::vector<Line> arrows = recorder.ofColor(settings.m_impulseColor);
    ASSERT_EQ(crosses.size(), 3u * contacts.size());
    for (const Line& line : crosses) EXPECT_NEAR(line.length(), 0.06, 1e-6);
    ASSERT_EQ(normals.size(), std::size_t(contacts.size()));
    double sum = 0;
    int carrying = 0;
    for (int k = 0; k < contacts.size(); ++k)
    {
        EXPECT_NEAR(normals[k].length(), 0.2, 1e-6);
        EXPECT_LT(normals[k].m_from.distance(contacts[k].m_point), 1e-6);
        EXPECT_GT(normals[k].m_to.z(), normals[k].m_from.z());
        carrying += contacts[k].m_impulse.length() > 0;
    }
    ASSERT_EQ(arrows.size(), 3u * carrying);
    for (std::size_t k = 0; k < arrows.size(); k += 3) sum += double(arrows[k].m_to.z() - arrows[k].m_from.z());
    EXPECT_NEAR(sum, 0.01 * 1000 * kGravity * double(kStep), 0.02);  // the body's weight
    settings.m_normalLength = settings.m_impulseScale = 0;
    EXPECT_EQ(drawn(BT_FEM_DRAW_CONTACTS, settings).m_lines.size(), crosses.size());
}

TEST_P(Drawing, ModesAddUpAndOthersDrawNothing)
{
    const std::size_t all = drawn(BT_FEM_DRAW_ELEMENTS | BT_FEM_DRAW_STRESS_FREE | BT_FEM_DRAW_CONTACTS).m_lines.size();
    EXPECT_EQ(all, drawn(BT_FEM_DRAW_ELEMENTS).m_lines.size() + drawn(BT_FEM_DRAW_STRESS_FREE).m_lines.size() +
                       drawn(BT_FEM_DRAW_CONTACTS).m_lines.size());
    EXPECT_EQ(drawn(0).m_lines.size(), 0u);
    Recorder recorder;
    btFemDebugDraw::draw(m_fem, nullptr, &recorder, 7);
    btFemDebugDraw::draw(m_fem, &m_body, nullptr, 7);
    m_world.deleteSoft(m_body);
    m_world.step();
    EXPECT_EQ(recorder.m_lines.size(), 0u);
}

TEST_P(Drawing, BadSettingsAreRejected)
{
    std::vector<btFemDrawSettings> bad(5);
    bad[0].m_shrink = 0;
    bad[1].m_shrink = btScalar(1.1);
    bad[2].m_pointSize = -1;
    bad[3].m_normalLength = NAN;
    bad[4].m_impulseScale = INFINITY;
    for (const btFemDrawSettings& settings : bad)
    {
        std::string why;
        EXPECT_FALSE(settings.valid(&why));
        EXPECT_FALSE(why.empty());
        EXPECT_THROW(drawn(7, settings), std::invalid_argument);
    }
}

TEST_P(Drawing, BulletsFlagsShowNodesFacesAndContacts)
{
    m_body.generateClusters(0);
    m_body.appendAnchor(0, &m_floor);
    m_world.step(2);
    for (int flag = 1; flag <= fDrawFlags::Joints; flag <<= 1)
    {
        Recorder recorder;
        btSoftBodyHelpers::Draw(&m_body, &recorder, flag);
        EXPECT_TRUE(recorder.allFinite()) << flag;
    }
    Recorder all, contacts, nodes;
    btSoftBodyHelpers::Draw(&m_body, &all, ~0);
    btSoftBodyHelpers::Draw(&m_body, &contacts, fDrawFlags::Contacts);
    btSoftBodyHelpers::Draw(&m_body, &nodes, fDrawFlags::Nodes);
    btSoftBodyHelpers::DrawInfos(&m_body, &all, true, true, true);
    EXPECT_EQ(nodes.m_lines.size(), 3u * m_body.m_nodes.size());
    ASSERT_GT(m_body.m_rcontacts.size(), 3);
    EXPECT_EQ(contacts.m_lines.size(), 3u * m_body.m_rcontacts.size());
    for (const Line& line : contacts.m_lines) EXPECT_NEAR(std::min(line.m_from.z(), line.m_to.z()), 0, 0.02);
}

TEST_P(Drawing, WorldDrawsItsBodies)
{
    Recorder recorder;
    m_world.bullet().setDebugDrawer(&recorder);
    for (const int mode : {int(btIDebugDraw::DBG_DrawWireframe), int(btIDebugDraw::DBG_DrawAabb), 0xffff})
    {
        recorder.m_mode = mode;
        recorder.m_lines.clear();
        m_world.bullet().debugDrawWorld();
        EXPECT_GT(recorder.m_lines.size(), 0u);
        EXPECT_TRUE(recorder.allFinite());
    }
    m_world.bullet().setDebugDrawer(nullptr);
}

// Directions along which pybullet divides the friction.
void expectTangents(const btSoftBody::DeformableFaceRigidContact& at, const btFemContact& contact)
{
    const btScalar eps = std::sqrt(SIMD_EPSILON);
    EXPECT_NEAR(at.t1.length(), 1, eps);
    EXPECT_NEAR(at.t2.length(), 1, eps);
    EXPECT_NEAR(at.t1.dot(at.t2), 0, eps);
    EXPECT_NEAR(at.t1.cross(at.t2).cross(contact.m_normal).length(), 0, eps);
    EXPECT_NEAR(at.t1.dot(contact.m_frictionImpulse), contact.m_frictionImpulse.length(),
                eps * contact.m_impulse.length());
}

TEST_P(Drawing, BulletsContactArraysMatchOurContacts)
{
    const auto& contacts = m_fem.contacts(&m_body);
    int touching = 0;
    for (int k = 0; k < contacts.size(); ++k)
    {
        if (!(contacts[k].m_normalImpulse > 0 || contacts[k].m_gap <= 0)) continue;
        const btSoftBody::RContact& atNode = m_body.m_rcontacts[touching];
        const btSoftBody::DeformableFaceRigidContact& atFace = m_body.m_faceRigidContacts[touching];
        ++touching;
        EXPECT_EQ(atNode.m_cti.m_colObj, &m_floor);
        EXPECT_EQ(atFace.m_cti.m_colObj, &m_floor);
        EXPECT_EQ(atNode.m_cti.m_normal, contacts[k].m_normal);
        EXPECT_NEAR(atNode.m_cti.m_normal.dot(contacts[k].m_point) + atNode.m_cti.m_offset, contacts[k].m_gap, 1e-6);
        EXPECT_LT(atNode.m_node->m_x.distance(contacts[k].m_point), 0.15);
        btVector3 point(0, 0, 0);
        for (int a = 0; a < 3; ++a) point += atFace.m_bary[a] * atFace.m_face->m_n[a]->m_x;
        EXPECT_LT(point.distance(contacts[k].m_point), 1e-3);
        EXPECT_EQ(atFace.m_contactPoint, contacts[k].m_point);
        EXPECT_EQ(atFace.m_c2, 0);  // ignored by Bullet's deformable solver
        expectTangents(atFace, contacts[k]);
    }
    EXPECT_GT(touching, 3);
    EXPECT_EQ(m_body.m_rcontacts.size(), touching);
    EXPECT_EQ(m_body.m_faceRigidContacts.size(), touching);
}

TEST_P(Drawing, BulletsContactArraysAreNeverSolved)
{
    const std::vector<btScalar> before = bitsOf(m_body);
    btSoftBody::PSolve_RContacts(&m_body, 1, 0);
    EXPECT_EQ(bitsOf(m_body), before);
}

TEST_P(Drawing, BulletsContactArraysAreEmptyForGoneObjectsOrInactiveBodies)
{
    ASSERT_GT(m_body.m_rcontacts.size(), 0);
    m_body.forceActivationState(DISABLE_SIMULATION);
    m_world.step();
    EXPECT_EQ(m_body.m_rcontacts.size() + m_body.m_faceRigidContacts.size(), 0);
    m_body.forceActivationState(DISABLE_DEACTIVATION);
    m_world.step();
    ASSERT_GT(m_body.m_rcontacts.size(), 0);
    m_world.deleteRigid(m_floor);
    m_world.step();
    EXPECT_EQ(m_body.m_rcontacts.size() + m_body.m_faceRigidContacts.size(), 0);
}

TEST_P(Drawing, BulletsContactArraysAreEmptyWhenTheBodyLiftsOffOrComesBack)
{
    m_body.translate(btVector3(0, 0, 1));
    m_world.step();
    EXPECT_EQ(m_body.m_rcontacts.size() + m_body.m_faceRigidContacts.size(), 0);
    m_body.translate(btVector3(0, 0, -1));
    m_world.step(3);
    ASSERT_GT(m_body.m_rcontacts.size(), 0);
    m_world.take(m_body);
    m_world.step();
    m_body.translate(btVector3(0, 0, 1));
    m_world.put(m_body);
    m_world.step();
    EXPECT_EQ(m_body.m_rcontacts.size() + m_body.m_faceRigidContacts.size(), 0);
}

// Partners of a removed body may be deleted, so its arrays are cleared.
TEST_P(Drawing, BulletsContactArraysAreEmptyWhenTheBodyHasLeftTheWorld)
{
    ASSERT_GT(m_body.m_rcontacts.size(), 0);
    m_world.take(m_body);
    EXPECT_EQ(m_body.m_rcontacts.size() + m_body.m_faceRigidContacts.size(), 0);
    m_world.deleteRigid(m_floor);
    for (int stepped = 0; stepped < 2; ++stepped)
    {
        Recorder contacts;
        btSoftBodyHelpers::Draw(&m_body, &contacts, fDrawFlags::Contacts);
        EXPECT_TRUE(contacts.m_lines.empty());
        EXPECT_TRUE(drawn(BT_FEM_DRAW_CONTACTS).allFinite());
        m_world.step();
    }
    EXPECT_TRUE(drawn(~0).m_lines.empty());
    m_world.put(m_body);
}

TEST_P(Drawing, BulletsContactArraysKeepOthersWhenAnObjectLeaves)
{
    RigidSettings settings;
    settings.m_transform.setOrigin(btVector3(btScalar(0.2), btScalar(0.2), btScalar(1.05)));
    btRigidBody& lid = m_world.addRigid(new btBoxShape(btVector3(1, 1, 1) * btScalar(0.1)), settings);
    m_world.step(2);
    const auto with = [this](const btCollisionObject& object)
    {
        int count = 0;
        for (int k = 0; k < m_body.m_rcontacts.size(); ++k) count += m_body.m_rcontacts[k].m_cti.m_colObj == &object;
        return count;
    };
    const int withLid = with(lid), withFloor = with(m_floor);
    ASSERT_GT(withLid, 0);
    ASSERT_GT(withFloor, 0);
    m_world.deleteRigid(m_floor);
    EXPECT_EQ(m_body.m_rcontacts.size(), withLid);
    EXPECT_EQ(m_body.m_faceRigidContacts.size(), withLid);
    EXPECT_EQ(with(lid), withLid);
}

// A rigid body deleted by a tick callback within the step does not appear in them.
class BulletsContactArrays : public EachWorldWith<Coupling>
{
};

TEST_P(BulletsContactArrays, ExcludeObjectsDeletedByATickCallback)
{
    FemWorld world(worldClass(), value());
    SoftBox box;
    box.m_center = {0, 0, 0.5};
    btSoftBody& body = addSoftBox(world, world.fem(), box);
    struct Scene
    {
        SoftWorld* m_world;
        btRigidBody* m_doomed;
        bool m_now;
    } scene = {&world, &world.addFloorBox(), false};
    const auto callback = [](btDynamicsWorld* bullet, btScalar)
    {
        auto& s = *static_cast<Scene*>(bullet->getWorldUserInfo());
        if (s.m_now && s.m_doomed) s.m_world->deleteRigid(*s.m_doomed), s.m_doomed = nullptr;
    };
    world.bullet().setInternalTickCallback(callback, &scene);
    world.step(60);
    ASSERT_GT(body.m_rcontacts.size(), 0);
    scene.m_now = true;
    world.step();
    EXPECT_EQ(body.m_rcontacts.size() + body.m_faceRigidContacts.size(), 0);
}

INSTANTIATE_TEST_SUITE_P(Swap, BulletsContactArrays, testing::Combine(eachWorld(), testing::Values(Coupling::swap)),
                         nameOfWorldWith(couplingName));
INSTANTIATE_TEST_SUITE_P(Coupled, BulletsContactArrays,
                         testing::Combine(testing::Values(WorldClass::softRigid), testing::Values(Coupling::coupled)),
                         nameOfWorldWith(couplingName));

}  // namespace
}  // namespace bullet_fem

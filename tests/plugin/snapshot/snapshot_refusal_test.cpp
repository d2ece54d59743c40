// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <random>
#include <stdexcept>
#include <string>

#include "plugin/record/btFemBodyRecord.h"
#include "plugin/record/btFemCoupling.h"
#include "plugin/scenes/snapshot_scene.h"
#include "plugin/snapshot/btFemEnvelope.h"

namespace bullet_fem
{
namespace
{

using testing::HasSubstr;
using Bytes = std::vector<unsigned char>;

/// A small scene with all kinds of saved data, with active contacts.
class RefusedSnapshot : public testing::Test
{
protected:
    RefusedSnapshot()
    {
        m_scene.addMesh();
        m_scene.add({{0.4, 0.4, 0.3}, {2, 2, 1}, {0.1, 8, 0.85}});
        m_scene.addBeam();
        m_scene.addCouple();
        m_scene.m_world.step(25);
        m_good = m_scene.save();
    }

    /// Expects that restoring is refused with this text in the reason, and that nothing has changed.
    void expectRefused(const Bytes& bytes, const std::string& reason)
    {
        const Bytes before = m_scene.save();
        std::string why;
        EXPECT_FALSE(m_scene.m_fem.restoreState(bytes.data(), bytes.size(), &why)) << reason;
        EXPECT_THAT(why, HasSubstr(reason));
        EXPECT_TRUE(m_scene.save() == before) << reason;
        EXPECT_THROW(m_scene.m_fem.restoreState(bytes.data(), bytes.size()), std::invalid_argument);
    }

    Bytes with(std::size_t at, unsigned char value) const
    {
        Bytes bytes = m_good;
        bytes[at] = value;
        return bytes;
    }

    /// Random changes of bytes, with a matching checksum.
    Bytes mutated(std::mt19937& random) const
    {
        constexpr std::size_t kHeader = 40;
        Bytes bytes = m_good;
        const auto below = [&random](std::size_t limit) { return static_cast<std::size_t>(random() % limit); };
        const std::size_t at = kHeader + below(bytes.size() - kHeader - 8);
        const double numbers[] = {std::numeric_limits<double>::quiet_NaN(), 1e300, -1e-300, 1e7, 0};
        const std::uint64_t counts[] = {0, 1, 1u << 31, std::uint64_t(1) << 62, ~std::uint64_t(0)};
        switch (below(6))
        {
            case 0:
                bytes[at] ^= static_cast<unsigned char>(1u << below(8));
                break;
            case 1:
                std::memcpy(&bytes[at], &numbers[below(5)], 8);
                break;
            case 2:
                std::memcpy(&bytes[at], &counts[below(5)], 8);
                break;
            case 3:
                bytes.erase(bytes.begin() + at, bytes.begin() + at + 1 + below(8));
                break;
            case 4:
                bytes.insert(bytes.begin() + at, 1 + below(8), static_cast<unsigned char>(random()));
                break;
            default:
                bytes.resize(at);
        }
        closeEnvelope(bytes);
        return bytes;
    }

    bool allFiniteNow() const
    {
        return std::all_of(m_scene.m_soft.begin(), m_scene.m_soft.end(),
                           [](const btSoftBody* body) { return allFinite(*body); });
    }

    SnapshotScene m_scene;
    Bytes m_good;
};

TEST_F(RefusedSnapshot, ForeignBytesAreRejected)
{
    expectRefused({}, "header");
    std::string why;
    EXPECT_FALSE(m_scene.m_fem.restoreState(nullptr, 100, &why));
    EXPECT_THROW(m_scene.m_fem.restoreState(nullptr, 0), std::invalid_argument);
    expectRefused(Bytes(1000, 7), "something else");
    expectRefused(with(0, 'b'), "something else");
    expectRefused(with(12, 99), "version 99");
    expectRefused(with(12, 1), "version 1");
    expectRefused(with(16, sizeof(btScalar) == 4 ? 8 : 4), "btScalar");
    expectRefused(with(20, 2), "not a saved state");
    Bytes other = m_good;
    std::reverse(other.begin() + 8, other.begin() + 12);
    expectRefused(other, "byte order");
    Bytes longer = m_good;
    longer.push_back(0);
    expectRefused(longer, "too long");
    closeEnvelope(longer);
    expectRefused(longer, "1 bytes too many");
}

TEST_F(RefusedSnapshot, TruncationIsRejected)
{
    std::string why;
    for (std::size_t size = 0; size < m_good.size(); size += size < 100 ? 1 : 997)
        EXPECT_FALSE(m_scene.m_fem.restoreState(m_good.data(), size, &why)) << size;
    expectRefused(Bytes(m_good.begin(), m_good.end() - 1), "cut off");
}

TEST_F(RefusedSnapshot, BitFlipsAreRejected)
{
    std::mt19937 random(1);
    std::string why;
    for (int k = 0; k < 3000; ++k)
    {
        Bytes bytes = m_good;
        bytes[random() % bytes.size()] ^= static_cast<unsigned char>(1u << random() % 8);
        EXPECT_FALSE(m_scene.m_fem.restoreState(bytes.data(), bytes.size(), &why));
    }
    EXPECT_TRUE(m_scene.save() == m_good);
}

TEST_F(RefusedSnapshot, MutationsAreRejectedOrTakenWithoutACrash)
{
    const SnapshotScene::Saved saved = m_scene.saveAll();
    const std::vector<double> bits = m_scene.run(10);
    m_scene.restore(saved);
    std::mt19937 random(2);
    int refused = 0, taken = 0;
    for (int k = 0; k < 6000; ++k)
    {
        const Bytes bytes = mutated(random);
        std::string why;
        if (!m_scene.m_fem.restoreState(bytes.data(), bytes.size(), &why))
        {
            ++refused;
            ASSERT_FALSE(why.empty());
            continue;
        }
        // Accepted data are a valid state, however unusual: steps from it must stay finite.
        if (++taken % 8 != 0) continue;
        m_scene.m_world.step(2);
        ASSERT_TRUE(allFiniteNow()) << "mutation " << k;
        m_scene.restore(saved);
    }
    EXPECT_GT(refused, 2000);
    EXPECT_GT(taken, 500);
    m_scene.restore(saved);
    EXPECT_TRUE(m_scene.run(10) == bits);
}

// A feature is an index that the next step uses.
TEST_F(RefusedSnapshot, ContactsOfInvalidFeaturesAreRejected)
{
    FemSoftBody& fem = btFemCoupling::femRecord(m_scene.m_fem, m_scene.m_soft[0], "test").fem();
    ASSERT_FALSE(fem.m_memory.m_origins.empty());
    const int feature = fem.m_memory.m_origins[0].m_feature;
    fem.m_memory.m_origins[0].m_feature = -3;
    const Bytes bytes = m_scene.save();
    fem.m_memory.m_origins[0].m_feature = feature;
    expectRefused(bytes, "the feature of a contact is -3, below 0");
}

TEST_F(RefusedSnapshot, InvalidPlacesOfSolidsAreRejected)
{
    ContactMemory& memory = btFemCoupling::femRecord(m_scene.m_fem, m_scene.m_soft[0], "test").fem().m_memory;
    const std::vector<Vec3> positions = memory.m_positions;
    memory.m_positions.assign(2, Vec3());
    Bytes bytes = m_scene.save();
    memory.m_positions = positions;
    expectRefused(bytes, "positions of 2 vertices are noted");
    SolidPlace solid;
    solid.m_pose.m_rotation(1, 2) = std::numeric_limits<double>::quiet_NaN();
    memory.m_solids.push_back(solid);
    bytes = m_scene.save();
    memory.m_solids.pop_back();
    expectRefused(bytes, "the numbers of the pose of a solid");
}

TEST_F(RefusedSnapshot, InvalidImpactsAreRejected)
{
    FemSoftBody& fem = btFemCoupling::femRecord(m_scene.m_fem, m_scene.m_soft[0], "test").fem();
    const auto expectImpactRefused = [&](const auto& spoil, const char* reason)
    {
        Impact impact;
        impact.m_other = m_scene.m_soft[1];
        impact.m_otherComponent = 0;
        impact.m_normal = {0, 0, 1};
        spoil(impact);
        fem.m_memory.m_impacts.assign(1, impact);
        const Bytes bytes = m_scene.save();
        fem.m_memory.m_impacts.clear();
        expectRefused(bytes, reason);
    };
    expectImpactRefused([](Impact& i) { i.m_restitution = 1.5; }, "the restitution of an impact is 1.5");
    expectImpactRefused([](Impact& i) { i.m_group = -1; }, "the group of an impact is -1");
    expectImpactRefused([](Impact& i) { i.m_component = 1; }, "the component of an impact is 1");
    expectImpactRefused([](Impact& i) { i.m_otherComponent = 7; }, "the component of an impact is 7");
    expectImpactRefused([](Impact& i) { i.m_normal.z = 2; }, "the normal of an impact has length 2");
    expectImpactRefused([](Impact& i) { i.m_energy = std::numeric_limits<double>::quiet_NaN(); },
                        "the numbers of an impact");
}

TEST_F(RefusedSnapshot, RemovedBodiesAreRejected)
{
    m_scene.m_world.deleteSoft(*m_scene.m_soft.back());
    m_scene.m_soft.pop_back();
    expectRefused(m_good, "is not in the world");
    m_scene.m_world.step(3);
    expectRefused(m_good, "is not in the world");
}

TEST_F(RefusedSnapshot, ReaddedBodyIsRejected)
{
    btSoftBody& body = *m_scene.m_soft[0];
    m_scene.m_world.world().removeSoftBody(&body);
    m_scene.m_world.world().addSoftBody(&body);
    expectRefused(m_good, "is not in the world");
}

TEST_F(RefusedSnapshot, CutBodyIsRejected)
{
    btSoftBody& body = *m_scene.m_soft[0];
    body.m_tetras.pop_back();
    expectRefused(m_good, "not FEM yet");
    m_scene.m_world.step();
    expectRefused(m_good, "now has 48 and 89");
}

TEST_F(RefusedSnapshot, OtherMaterialIsRejected)
{
    btFemMaterial material;
    material.m_youngModulus = btScalar(2e5);
    material.m_stiffnessDamping = btScalar(0.01);
    m_scene.m_fem.setMaterial(m_scene.m_soft[0], material);
    expectRefused(m_good, "material");
    m_scene.m_world.step(2);
    expectRefused(m_good, "material");
    material.m_stiffnessDamping = btFemMaterial().m_stiffnessDamping;  // the former value
    material.m_meanDilatation = btFemMeanDilatation::on;
    m_scene.m_fem.setMaterial(m_scene.m_soft[0], material);
    m_scene.m_world.step(2);
    expectRefused(m_good, "material");
    material.m_meanDilatation = btFemMeanDilatation::automatic;
    m_scene.m_fem.setMaterial(m_scene.m_soft[0], material);
    m_scene.m_fem.restoreState(m_good.data(), m_good.size());
    EXPECT_TRUE(m_scene.save() == m_good);
}

/// Result of saving or restoring in a tick callback.
struct TriesWithinAStep
{
    static void tick(btDynamicsWorld* world, btScalar)
    {
        auto& tries = *static_cast<TriesWithinAStep*>(world->getWorldUserInfo());
        Bytes bytes;
        EXPECT_FALSE(tries.m_fem.saveState(bytes, &tries.m_saving));
        EXPECT_THROW(tries.m_fem.saveState(bytes), std::invalid_argument);
        EXPECT_FALSE(tries.m_fem.restoreState(tries.m_good.data(), tries.m_good.size(), &tries.m_restoring));
    }

    btFemSoftBodySolver& m_fem;
    const Bytes& m_good;
    std::string m_saving, m_restoring;
};

TEST_F(RefusedSnapshot, CallsWithinAStepAreRejected)
{
    TriesWithinAStep tries{m_scene.m_fem, m_good, {}, {}};
    m_scene.m_world.world().setInternalTickCallback(&TriesWithinAStep::tick, &tries);
    m_scene.m_world.step();
    EXPECT_THAT(tries.m_saving, HasSubstr("between steps"));
    EXPECT_THAT(tries.m_restoring, HasSubstr("between steps"));
}

TEST_F(RefusedSnapshot, MissingBroadPhaseIsRejected)
{
    btBroadphaseInterface* broadphase = m_scene.m_world.info().m_broadphase;
    m_scene.m_world.info().m_broadphase = nullptr;
    Bytes bytes;
    std::string why;
    EXPECT_FALSE(m_scene.m_fem.saveState(bytes, &why));
    EXPECT_THAT(why, HasSubstr("m_broadphase"));
    m_scene.m_world.info().m_broadphase = broadphase;
    expectRefused(Bytes(40, 0), "something else");
}

TEST_F(RefusedSnapshot, OtherFactorChoiceIsRejected)
{
    btFemSolverInfo info;
    info.m_factorChoice = btFemFactorChoice::lowMemory;
    SnapshotScene full, low(Coupling::swap, info);
    for (SnapshotScene* scene : {&full, &low}) scene->addTower(), scene->m_world.step(2);
    const Bytes bytes = full.save(), before = low.save();
    std::string why;
    EXPECT_FALSE(low.m_fem.restoreState(bytes.data(), bytes.size(), &why));
    EXPECT_THAT(why, HasSubstr("m_factorChoice"));
    EXPECT_TRUE(low.save() == before);
}

TEST(RestoredSnapshot, ShowsTheSavedManifolds)
{
    btFemSolverInfo info;
    info.m_manifolds = true;
    SnapshotScene scene(Coupling::swap, info);
    scene.addTower();
    const auto pointsShown = [&scene]
    {
        int points = 0;
        const btDispatcher& dispatcher = *scene.m_world.world().getDispatcher();
        for (int k = 0; k < dispatcher.getNumManifolds(); ++k)
            points += const_cast<btDispatcher&>(dispatcher).getManifoldByIndexInternal(k)->getNumContacts();
        return points;
    };
    scene.m_world.step(30);
    const Bytes bytes = scene.save();
    const int points = pointsShown();
    ASSERT_GT(points, 4);
    scene.m_soft[1]->translate(btVector3(0, 0, btScalar(0.05)));  // the pair's bounds still overlap
    scene.m_world.step();
    ASSERT_LT(pointsShown(), points);
    scene.m_fem.restoreState(bytes.data(), bytes.size());
    EXPECT_EQ(pointsShown(), points);
}

TEST(RestoredSnapshot, OmitsRemovedBodiesAndLeavesNewOnesAlone)
{
    SnapshotScene scene;
    scene.addTower();
    scene.addBeam();
    scene.m_world.step(30);
    const SnapshotScene::Saved saved = scene.saveAll();
    const int contacts = scene.m_fem.contacts(scene.m_soft[1]).size();
    btSoftBody& late = scene.add({{0.3, 0.3, 0.3}, {2, 2, 2}, {3, 3, 0.2}});
    scene.m_world.step(5);
    for (btRigidBody* body : scene.m_rigid) scene.m_world.deleteRigid(*body);
    scene.m_rigid.clear();
    const std::vector<btScalar> before = bitsOf(late);
    scene.m_fem.restoreState(saved.m_fem.data(), saved.m_fem.size());
    EXPECT_EQ(bitsOf(late), before);
    EXPECT_LT(scene.m_fem.contacts(scene.m_soft[1]).size(), contacts);
    EXPECT_EQ(scene.m_fem.anchors(scene.m_soft[2]).size(), 0);
    scene.m_world.step(30);
    for (const btSoftBody* body : scene.m_soft) EXPECT_TRUE(allFinite(*body));
    EXPECT_EQ(scene.m_fem.touches(scene.m_soft[1]).size(), 1);
}

TEST(RestoredSnapshot, IsEmptyWithoutBodies)
{
    SnapshotScene scene;
    Bytes bytes;
    scene.m_fem.saveState(bytes);
    scene.m_fem.restoreState(bytes.data(), bytes.size());
    scene.addTower();
    scene.m_world.step(3);
    scene.m_fem.restoreState(bytes.data(), bytes.size());
    scene.m_world.step(3);
    EXPECT_GT(scene.contacts(), 0);
}

}  // namespace
}  // namespace bullet_fem

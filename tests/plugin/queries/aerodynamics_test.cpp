// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// Wind and water: Bullet's formulas, and the motion of Bullet's own bodies.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

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

// Bullet's formula for nodes: with a node's area A, normal n, v relative to the wind, dvn = v . n > 0 (two-sided: |v .
// n|), f = -rho A dvn v^2 / 2 (kLF n + kDG v / |v|).
class Aerodynamics : public EachWorldWith<btSoftBody::eAeroModel::_>
{
protected:
    static btVector3 expectedForce(const btSoftBody& body, const btVector3& wind, double density)
    {
        btVector3 sum(0, 0, 0);
        for (int i = 0; i < body.m_nodes.size(); ++i)
        {
            const btSoftBody::Node& node = body.m_nodes[i];
            const btVector3 v = node.m_v - wind;
            btScalar along = v.dot(node.m_n);
            const bool twoSided = body.m_cfg.aeromodel == btSoftBody::eAeroModel::V_TwoSided;
            const btVector3 n = twoSided && along < 0 ? -node.m_n : node.m_n;
            along = v.dot(n);
            if (along <= 0) continue;
            const btScalar c = btScalar(density) * node.m_area * along * v.length2() / 2;
            sum -= c * (body.m_cfg.kLF * n + body.m_cfg.kDG * v.normalized());
        }
        return sum;
    }
};

TEST_P(Aerodynamics, DragAndLiftAreBulletsFormulasAndWaterHasNoneAsInBullet)
{
    FemWorld world(worldClass(), btVector3(0, 0, 0));
    btFemSoftBodySolver& fem = world.fem();
    SoftBox box;
    btSoftBody& body = addSoftBox(world, fem, box);
    const btVector3 speed(btScalar(2), btScalar(1), btScalar(-0.5)), wind(0, btScalar(3), 0);
    body.setVelocity(speed);
    body.setWindVelocity(wind);
    body.m_cfg.aeromodel = value();
    body.m_cfg.kDG = btScalar(0.3);
    body.m_cfg.kLF = btScalar(0.1);
    world.info().air_density = btScalar(1.5);
    // All of it is under water: Bullet 3.24 reads these values, but uses the density of air.
    world.info().water_density = 1000;
    world.info().water_normal = btVector3(0, 0, 1);
    world.info().water_offset = -50;
    body.updateArea();
    const Vec3 expected = vec3(expectedForce(body, wind, 1.5));
    ASSERT_GT(norm(expected), 1);
    world.step();
    const Vec3 gained = motionOf(body).m_linear - massOf(body) * vec3(speed);
    EXPECT_LT(norm(gained - double(kStep) * expected), 2e-3 * norm(double(kStep) * expected) + 2e-4);
}

std::string modelName(btSoftBody::eAeroModel::_ model)
{
    const char* names[] = {"V_Point",    "V_TwoSided",         "V_TwoSidedLiftDrag", "V_OneSided",
                           "F_TwoSided", "F_TwoSidedLiftDrag", "F_OneSided"};
    return names[model];
}

INSTANTIATE_TEST_SUITE_P(Models, Aerodynamics,
                         testing::Combine(eachWorld(), testing::Values(btSoftBody::eAeroModel::V_Point,
                                                                       btSoftBody::eAeroModel::V_TwoSided,
                                                                       btSoftBody::eAeroModel::V_OneSided)),
                         nameOfWorldWith(modelName));

const btVector3 kSpin(0, 3, 1);  // of the cube [rad/s]

class Water : public EachWorldWith<btSoftBody::eAeroModel::_>
{
protected:
    // Velocities after a step of a cube with nearly zero stiffness, without links, that flies and spins through the
    // wind.
    static std::vector<btScalar> stepped(SoftWorld& world, btFemSoftBodySolver* fem, double waterDensity,
                                         btScalar drag = btScalar(0.3))
    {
        btSoftBody& body = addUnitCube(world, btVector3(0, 0, 0));
        if (fem)
        {
            btFemMaterial soft;
            soft.m_youngModulus = 1;
            soft.m_density = 0;  // masses are kept
            fem->setMaterial(&body, soft);
        }
        body.m_cfg.collisions = 0;
        body.m_cfg.aeromodel = value();
        body.m_cfg.kDG = drag;
        body.m_cfg.kLF = drag / 3;
        body.m_cfg.kPR = 40;
        body.setWindVelocity(btVector3(3, 0, 1));
        for (int i = 0; i < body.m_nodes.size(); ++i)
            body.m_nodes[i].m_v = btVector3(2, 1, 0) + kSpin.cross(body.m_nodes[i].m_x);
        world.info().air_density = btScalar(1.5);
        world.info().water_density = btScalar(waterDensity);
        world.info().water_normal = btVector3(0, 0, 1);  // all of it is 50 m deep
        world.info().water_offset = -50;
        body.m_bUpdateRtCst = false;  // Bullet alone would build a tree from the links
        body.updateArea();
        body.updateNormals();
        world.step();
        std::vector<btScalar> velocities;
        for (int i = 0; i < body.m_nodes.size(); ++i)
            for (int c = 0; c < 3; ++c) velocities.push_back(body.m_nodes[i].m_v[c]);
        return velocities;
    }

    static std::vector<btScalar> ofBullet(double waterDensity, btScalar drag = btScalar(0.3))
    {
        btDefaultSoftBodySolver plain;
        SoftWorld world(plain);
        return stepped(world, nullptr, waterDensity, drag);
    }
    static std::vector<btScalar> ofFem(double waterDensity, btScalar drag = btScalar(0.3))
    {
        btFemSolverInfo info;
        info.m_tolerance = btScalar(1e-6);
        FemWorld world(worldClass(), info);
        return stepped(world, &world.fem(), waterDensity, drag);
    }

    static double largestDifference(const std::vector<btScalar>& a, const std::vector<btScalar>& b)
    {
        double largest = 0;
        for (std::size_t k = 0; k < a.size(); ++k) largest = std::max(largest, std::fabs(double(a[k]) - double(b[k])));
        return largest;
    }

    static std::vector<btScalar> difference(std::vector<btScalar> a, const std::vector<btScalar>& b)
    {
        for (std::size_t k = 0; k < a.size(); ++k) a[k] -= b[k];
        return a;
    }
};

// Bullet 3.24 looks up the medium, but uses the density of air: in water a body has the forces of air.
TEST_P(Water, HasNoEffectAsOnBulletsBodies)
{
    const std::vector<btScalar> bullet = ofBullet(1000), inAir = ofBullet(0), fem = ofFem(1000);
    EXPECT_EQ(bullet, inAir);
    EXPECT_EQ(fem, ofFem(0));
    const std::vector<btScalar> bulletCalm = ofBullet(1000, 0), femCalm = ofFem(1000, 0);
    const double wind = largestDifference(bullet, bulletCalm);
    EXPECT_GT(wind, 1e-4);
    constexpr double kRounding = 1e-5;  // [m/s]: Bullet rounds x by x / h
    // The FEM cube turns by phi a step, and its nodes then move along the arc of phi instead of atan phi. Velocities u
    // from the wind add phi^2 u to this, and turn by half of phi a second time, to second order.
    const double phi = double(kSpin.length()) * double(kStep), square = phi * phi;
    const double fastest = double(kSpin.cross({btScalar(0.5), btScalar(-0.5), btScalar(0.5)}).length());
    EXPECT_LT(largestDifference(femCalm, bulletCalm), square * phi / 3 * fastest + kRounding);
    EXPECT_LT(largestDifference(difference(fem, femCalm), difference(bullet, bulletCalm)),
              (1e-3 + square + square / 4) * wind + kRounding);
}

INSTANTIATE_TEST_SUITE_P(
    Models, Water,
    testing::Combine(eachWorld(),
                     testing::Values(btSoftBody::eAeroModel::V_Point, btSoftBody::eAeroModel::V_TwoSided,
                                     btSoftBody::eAeroModel::V_TwoSidedLiftDrag, btSoftBody::eAeroModel::V_OneSided,
                                     btSoftBody::eAeroModel::F_TwoSided, btSoftBody::eAeroModel::F_TwoSidedLiftDrag,
                                     btSoftBody::eAeroModel::F_OneSided)),
    nameOfWorldWith(modelName));

}  // namespace
}  // namespace bullet_fem

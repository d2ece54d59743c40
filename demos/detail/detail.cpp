// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// A camera flies along a row of soft plants in the wind. Near plants are solved to the full tolerance, distant ones
// with less detail. Colours show it: red full tolerance, yellow and green a residual of 5 %, green with a single
// rotation for the whole body.
#include <algorithm>
#include <cmath>

#include "bullet_fem/btFemHelpers.h"
#include "demos/common/demo.h"
#include "demos/common/demo_measures.h"
#include "demos/common/demo_world.h"

namespace
{
using namespace bullet_fem;

constexpr int kPlants = 24;
constexpr double kHeight = 1.2, kSpacing = 1.2;  // [m]
constexpr double kNear = 3, kFar = 9;            // distances at which interest begins to fade and ends [m]

/// Adds plants in two rows, rooted in the ground.
std::vector<btSoftBody*> plant(DemoWorld& world)
{
    btFemMaterial material;
    material.m_youngModulus = btScalar(5e6);
    material.m_stiffnessDamping = btScalar(0.01);
    std::vector<btSoftBody*> plants;
    for (int k = 0; k < kPlants; ++k)
    {
        const btVector3 root = at(kSpacing * (k / 2), 0, k % 2 ? 0.8 : -0.8);
        btSoftBody* body = btFemHelpers::createBox(world.info(), root + at(0, kHeight / 2, 0),
                                                   at(0.08, kHeight / 2, 0.08), btScalar(0.08));
        for (int i = 0; i < body->m_nodes.size(); ++i)
            if (body->m_nodes[i].m_x.y() < btScalar(0.01)) body->setMass(i, 0);
        plants.push_back(&world.addSoft(body, material));
    }
    return plants;
}

/// Applies gusts that travel along the row.
void blow(const std::vector<btSoftBody*>& plants, double strength, double time)
{
    for (btSoftBody* body : plants)
    {
        const double gust = strength * std::sin(3 * time - double(body->m_nodes[0].m_x.x()));
        for (int i = 0; i < body->m_nodes.size(); ++i)
            if (body->m_nodes[i].m_im > 0) body->addForce(at(gust, 0, gust / 2) / body->m_nodes[i].m_im, i);
    }
}

btFemSolverInfo eulerThroughout()
{
    btFemSolverInfo info;
    info.m_numericalDamping = 1;  // as in contact: one factor serves both, and reduced detail saves time
    return info;
}

void play(Demo& demo, double gust, double nearDistance, double behind)
{
    DemoWorld world(eulerThroughout()), full(eulerThroughout());  // `full` has no levels of detail, for comparison
    const std::vector<btSoftBody*> plants = plant(world), fullPlants = plant(full);
    world.addMarker(new btStaticPlaneShape(at(0, 1, 0), 0), at(0, 0, 0));  // contact requires full detail
    btFemViewerInterest interest{btScalar(nearDistance), btScalar(nearDistance + kFar - kNear)};
    world.fem().setInterest(&interest);

    const Vec3 colours[] = {{0.80, 0.30, 0.25}, {0.80, 0.30, 0.25}, {0.35, 0.62, 0.35}, {0.85, 0.70, 0.30}};
    double apart = 0, work = 0, fullWork = 0;
    int wrong = 0, levels[4] = {0, 0, 0, 0};
    do
    {
        const double way = -3 + 2.2 * demo.time();
        const btVector3 eye = at(way, 1.3, 3.2);
        interest.setViewer(eye - at(behind, 0, 0));
        demo.look(eye, eye + at(4, -0.7, -2.8));
        for (std::size_t k = 0; k < plants.size(); ++k)
        {
            const btFemStepReport& report = world.fem().stepReport(plants[k]);
            demo.paint(*plants[k], colours[static_cast<int>(report.m_detail)]);
            work += report.m_iterations;
            fullWork += full.fem().stepReport(fullPlants[k]).m_iterations;
            ++levels[static_cast<int>(report.m_detail)];
            const double distance = (centreOf(*plants[k]) - eye).length();
            wrong += distance < 0.9 * nearDistance && demo.time() > 0 && report.m_detail != btFemDetail::nodalWarp;
            apart = std::max(apart, double((highestOf(*plants[k]) - highestOf(*fullPlants[k])).length()));
        }
        blow(plants, gust, demo.time());
        blow(fullPlants, gust, demo.time());
        if (demo.time() < demo.seconds()) full.bullet().stepSimulation(btScalar(kDemoStep), 0);
    } while (demo.step(world.bullet()));
    const double all = levels[0] + levels[1] + levels[2] + levels[3];
    demo.figure("solved in full", 100 * levels[0] / all, "%");
    demo.figure("with one iteration", 100 * levels[3] / all, "%");
    demo.figure("in direct mode", 100 * levels[2] / all, "%");
    demo.check("near plants without full detail", wrong, 0, 0, "");
    demo.check("iterations / those in full", work / fullWork, 0.1, 0.95, "", 5);
    demo.check("tips apart from full detail / height", apart / kHeight, 0, 0.03, "");
}

}  // namespace

int main(int argc, char** argv)
{
    Demo demo("detail", "A camera flies along soft plants; distant ones are solved with less detail.", 5);
    double gust = 8, nearDistance = kNear, behind = 0;
    demo.option("--gust", gust, 0, 100, "acceleration by the wind [m/s2]");
    demo.option("--near", nearDistance, 0, 1e3, "distance of full interest [m]");
    demo.option("--behind", behind, 0, 1e3, "distance of the solver's viewer position behind the camera [m]");
    return demo.run(argc, argv, [&] { play(demo, gust, nearDistance, behind); });
}

// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// A ball, a tilted brick and a seesaw at 60 Hz (orange), in front of the same in undamped steps of 1/1920 s (grey).
#include <algorithm>
#include <cmath>

#include "bullet_fem/btFemHelpers.h"
#include "bullet_fem/fem/mesh/generators.h"
#include "demos/common/demo.h"
#include "demos/common/demo_measures.h"
#include "demos/common/demo_world.h"

namespace
{
using namespace bullet_fem;

constexpr int kSmallSteps = 32;                              // in a step of 1/60 s
constexpr double kFall = 1, kTilt = 0.5;                     // [m], of the brick [rad]
constexpr double kPivot = 0.3, kSlope = 0.2, kSeesaw = 1.2;  // height [m], slope [rad] and place [m] of the board
constexpr double kBoard = 1, kHalfBoard = 0.05;              // half its length and thickness [m]

/// The exhibits in a world of their own.
class Exhibits
{
public:
    Exhibits(const btFemSolverInfo& info, double step, double aside) : m_world(info), m_step(step), m_aside(aside)
    {
        m_world.addGround();
        m_ball = &add(btFemHelpers::createFromTetMesh(m_world.info(), makeSphere(0.2, 6)), -0.8, kFall, 1e6, 0);
        btSoftBody* brick = btFemHelpers::createBox(m_world.info(), at(0, 0, 0), at(0.2, 0.1, 0.1), 0.05f);
        brick->rotate(btQuaternion(at(0, 0, 1), btScalar(-kTilt)));
        m_brick = &add(brick, -1.7, kFall, 1e7, 0);
        const btTransform pose(btQuaternion(at(0, 0, 1), btScalar(kSlope)), at(kSeesaw, kPivot, aside));
        m_board = &m_world.addRigid(new btBoxShape(at(kBoard, kHalfBoard, 0.2)), 10, pose);
        m_world.addJoint<btHingeConstraint>(*m_board, at(0, 0, 0), at(0, 0, 1));
        m_thrown = &addCube(0.2, -0.85, 0.01);
        m_heavy = &addCube(0.3, 0.8, kFall);
    }

    btSoftRigidDynamicsWorld& bullet() { return m_world.bullet(); }
    std::vector<btCollisionObject*> objects() const { return {m_ball, m_brick, m_board, m_thrown, m_heavy}; }

    void step()
    {
        m_world.bullet().stepSimulation(btScalar(m_step), 0);
        note();
    }
    /// Notes the largest heights.
    void note()
    {
        m_ballMet = m_ballMet || m_world.fem().contacts(m_ball).size() > 0;
        if (m_ballMet && velocityOf(*m_ball).y() > 0) m_ballTop = std::max(m_ballTop, double(lowestOf(*m_ball).y()));
        m_thrownTop = std::max(m_thrownTop, double(lowestOf(*m_thrown).y()));
    }

    double m_ballTop = 0, m_thrownTop = 0;  // [m]

private:
    btSoftBody& add(btSoftBody* body, double x, double height, double young, double damping)
    {
        btFemMaterial rubber;
        rubber.m_youngModulus = btScalar(young);
        rubber.m_density = 1000;
        rubber.m_stiffnessDamping = btScalar(damping);
        body->translate(at(x, height - double(lowestOf(*body).y()), m_aside));
        return m_world.addSoft(body, rubber, 0.5, m_step);
    }
    /// Adds a cube at x along the board, at this height above it.
    btSoftBody& addCube(double edge, double x, double height)
    {
        const btScalar half = btScalar(edge / 2);
        const double board = kPivot + std::tan(kSlope) * (x + edge / 2) + 1.02 * kHalfBoard;
        return add(btFemHelpers::createBox(m_world.info(), at(0, 0, 0), {half, half, half}, btScalar(edge / 4)),
                   kSeesaw + x, board + height, 1e6, 0.005);
    }

    DemoWorld m_world;
    const double m_step, m_aside;
    btSoftBody *m_ball, *m_brick, *m_thrown, *m_heavy;
    btRigidBody* m_board;
    bool m_ballMet = false;
};

}  // namespace

int main(int argc, char** argv)
{
    Demo demo("rebound", "A ball, a tilted brick and a seesaw at 60 Hz, in front of the same in small steps.", 2);
    bool isOff = false;
    demo.flag("--no-rebound", isOff, "without m_elasticRebound");
    const auto scene = [&]
    {
        btFemSolverInfo info, small;
        info.m_elasticRebound = !isOff;
        small.m_contactDamping = 0;
        small.m_elasticRebound = false;
        Exhibits ours(info, kDemoStep, 0.35), converged(small, kDemoStep / kSmallSteps, -0.35);
        for (btCollisionObject* object : ours.objects()) demo.paint(*object, {0.86, 0.52, 0.30});
        for (btCollisionObject* object : converged.objects()) demo.paint(*object, {0.60, 0.63, 0.68});
        demo.look(at(0.05, 1.6, 5.8), at(0.05, 0.75, 0));
        demo.drawBeside(&converged.bullet());
        while (demo.step(ours.bullet()))
        {
            ours.note();
            for (int k = 0; k < kSmallSteps; ++k) converged.step();
        }
        demo.drawBeside(nullptr);
        demo.figure("converged: ball's height", converged.m_ballTop, "m");
        demo.figure("converged: thrown cube's height", converged.m_thrownTop, "m");
        demo.check("ball: height / converged", ours.m_ballTop / converged.m_ballTop, 0.9, 1.1, "", 1);
        demo.check("seesaw: height / converged", ours.m_thrownTop / converged.m_thrownTop, 0.8, 1.1, "", 2);
    };
    return demo.run(argc, argv, scene);
}

// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// A tower of jelly blocks and rigid boards stands, and is then hit by a ball.
#include <algorithm>
#include <cmath>

#include "bullet_fem/btFemHelpers.h"
#include "demos/common/demo.h"
#include "demos/common/demo_measures.h"
#include "demos/common/demo_world.h"

namespace
{
using namespace bullet_fem;

constexpr int kFloors = 4;                                   // one jelly block and one board each
constexpr double kEdge = 0.5, kJelly = 0.25, kBoard = 0.12;  // [m]
constexpr double kBoardMass = 4, kShot = 2.5;                // [kg], launch time of the ball [s]
constexpr double kHeight = kFloors * (kJelly + kBoard);

struct Tower
{
    std::vector<btSoftBody*> m_jellies;
    std::vector<btRigidBody*> m_boards;
    double m_weight = 0;  // [N]

    double fastest() const
    {
        double speed = 0;
        for (const btRigidBody* board : m_boards) speed = std::max(speed, double(board->getLinearVelocity().length()));
        for (const btSoftBody* jelly : m_jellies) speed = std::max(speed, double(velocityOf(*jelly).length()));
        return speed;
    }
    btVector3 top() const { return m_boards.back()->getCenterOfMassPosition(); }
};

Tower build(Demo& demo, DemoWorld& world, double young)
{
    btFemMaterial jelly = btFemMaterial::jelly();
    jelly.m_law = btFemElasticLaw::hooke;  // no block is crushed, and Hooke's law costs less per step
    jelly.m_youngModulus = btScalar(young);
    jelly.m_density = 300;
    Tower tower;
    for (int k = 0; k < kFloors; ++k)
    {
        const double y = k * (kJelly + kBoard);
        btSoftBody* body = btFemHelpers::createBox(world.info(), at(0, y + kJelly / 2, 0),
                                                   at(kEdge / 2, kJelly / 2, kEdge / 2), btScalar(kEdge / 6));
        tower.m_jellies.push_back(&world.addSoft(body, jelly, 0.7));
        tower.m_boards.push_back(&world.addRigid(new btBoxShape(at(kEdge / 2, kBoard / 2, kEdge / 2)), kBoardMass,
                                                 at(0, y + kJelly + kBoard / 2, 0)));
        demo.paint(*tower.m_boards.back(), {0.76, 0.62, 0.44});
        tower.m_weight += (massOf(*body) + kBoardMass) * kGravity;
    }
    return tower;
}

void play(Demo& demo, double young, double ballMass, double friction)
{
    DemoWorld world;
    btRigidBody& ground = world.addGround(friction);
    const Tower tower = build(demo, world, young);
    demo.look(at(1.7, 1.7, 5), at(0.9, 0.6, 0));

    double carried = 0, fastest = 0, standing = 0;
    int samples = 0;
    btRigidBody* ball = nullptr;
    do
    {
        if (demo.time() > kShot - 1 && !ball)  // measures the standing tower for a second
        {
            carried += double(world.fem().contactForce(tower.m_jellies[0], &ground).y());
            ++samples;
            fastest = std::max(fastest, tower.fastest());
            standing = tower.top().y() + kBoard / 2;
        }
        if (demo.time() > kShot && !ball)
        {
            ball = &world.addRigid(new btSphereShape(btScalar(0.18)), ballMass, at(-3, 0.9, 0.05));
            ball->setLinearVelocity(at(11, 1.2, 0));
        }
    } while (demo.step(world.bullet()));

    demo.figure("weight", tower.m_weight, "N");
    demo.figure("height at rest / at the start", standing / kHeight, "");
    demo.check("force of the ground / weight", carried / samples / tower.m_weight, 0.99, 1.01, "", kShot);
    demo.check("fastest before the hit", fastest, 0, 0.01, "m/s", kShot);
    demo.check("height at rest / at the start", standing / kHeight, 0.85, 1, "", kShot);
    demo.check("top board after the hit", tower.top().y(), 0, 0.5 * kHeight, "m", kShot + 2);
    demo.check("fastest at the end", tower.fastest(), 0, 0.2, "m/s", kShot + 4);
}

}  // namespace

int main(int argc, char** argv)
{
    Demo demo("tower", "A tower of jelly and rigid boxes stands, and is hit by a ball.", 7);
    double young = 3e4, ballMass = 12, friction = 1;
    demo.option("--young", young, 1e2, 1e9, "Young's modulus of the jelly [Pa]");
    demo.option("--ball", ballMass, 1e-3, 1e3, "mass of the ball [kg]");
    demo.option("--friction", friction, 0, 2, "friction of the ground [-]");
    return demo.run(argc, argv, [&] { play(demo, young, ballMass, friction); });
}

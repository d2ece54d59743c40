// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// Bullet's pybullet examples deformable_ball and deformable_torus, and DeformableClothAnchor with a slab in place of
// its cloth.
#include <utility>

#include "examples/deformable_example.h"

namespace bullet_fem
{
namespace
{

constexpr int kFlags = btSoftBody::fCollision::SDF_RD | btSoftBody::fCollision::SDF_RDF | btSoftBody::fCollision::VF_DD;

double lowest(const btSoftBody& body)
{
    double y = 1e30;
    for (int i = 0; i < body.m_nodes.size(); ++i) y = std::min(y, double(body.m_nodes[i].m_x.y()));
    return y;
}

class DeformableBalls : public DeformableExample
{
protected:
    DeformableBalls()
    {
        setGravity(10);
        m_ground = &addRigidBox({100, 5, 100}, {0, -7, 0}, 0, 1);
    }
    btSoftBody& addBall(const TetMesh& mesh, ExampleBlock block, std::unique_ptr<btDeformableNeoHookeanForce> elastic)
    {
        block.m_collisions = kFlags;
        btSoftBody& ball = addBlock(mesh, block);
        addGravity(ball);
        addForce(m_world, ball, std::move(elastic));
        return ball;
    }

    btRigidBody* m_ground;  // its top is at y = -2
};

TEST_F(DeformableBalls, BallBouncesWithLittleLoss)
{
    const double mass = 4, step = 0.001, radius = 0.5;
    const ExampleBlock block = {
        {btScalar(0.5), btScalar(0.5), btScalar(0.5)}, {0, -1, 0}, btScalar(mass), btScalar(0.5)};
    btSoftBody& ball =
        addBall(makeSphere(1, 6), block, std::make_unique<btDeformableNeoHookeanForce>(400, 600, btScalar(0.001)));
    btRigidBody& box = addRigidBox({btScalar(0.5), btScalar(0.5), btScalar(0.5)}, {3, 2, 0}, 1, 1);
    EnergyBook book(fem(), m_gravity);
    book.addSoft(ball, 1040, 0.3, btFemElasticLaw::neoHooke);
    book.addRigid(box);
    book.open();
    // Free fall over half a metre, until t = sqrt(2 s / g).
    const double top = centerOf(ball).y, fall = top - radius + 2;
    const int landing = static_cast<int>(std::sqrt(2 * fall / 10) / step);
    run(book, landing - 2, step);
    EXPECT_NEAR(lowest(ball), -2, 0.02);
    EXPECT_NEAR(velocityOf(ball).y, -std::sqrt(2 * 10 * fall), 0.05);
    double momentum = motionOf(ball).m_linear.y, highest = -2, deepest = 0;
    for (int k = landing - 2; k < 1200; ++k)
    {
        run(book, 1, step);
        momentum += impulseOn(fem(), ball).y - mass * 10 * step;
        highest = std::max(highest, centerOf(ball).y);
        deepest = std::max(deepest, -2 - lowest(ball));
    }
    EXPECT_NEAR(motionOf(ball).m_linear.y, momentum, 1e-4 * mass * 3);
    EXPECT_LT(highest, top);
    EXPECT_GT(highest - radius + 2, 0.5 * fall);  // it vibrates while it rises
    EXPECT_LT(deepest, 0.01 * radius);
    EXPECT_GT(m_flattest, 0.4);
    EXPECT_LT(book.made(), 1e-3 * mass * 10 * fall);
    EXPECT_NEAR(box.getCenterOfMassPosition().y(), -1.5, 0.02);
}

TEST_F(DeformableBalls, ToriFallOnEachOtherAndLieDown)
{
    const double young = 180 * (3 * 600 + 2 * 180) / 780.0, poisson = 600 / (2 * 780.0);
    EnergyBook book(fem(), m_gravity);
    std::vector<btSoftBody*> tori;
    for (const btVector3& center : {btVector3(0, 0, 0), btVector3(0, btScalar(0.5), 1)})
    {
        tori.push_back(&addBall(exampleTorus(), {{1, 1, 1}, center, 3, btScalar(0.5)},
                                std::make_unique<btDeformableNeoHookeanForce>(180, 600, btScalar(0.01))));
        book.addSoft(*tori.back(), young, poisson, btFemElasticLaw::neoHooke);
    }
    book.open();
    bool touched = false;
    run(book, 600, 1.0 / 240, [&](int) { touched = touched || fem().contactForce(tori[0], tori[1]).length() > 0; });
    EXPECT_TRUE(touched);
    double support = 0;
    for (int k = 0; k < 60; ++k)
    {
        run(book, 1, 1.0 / 240);
        for (const btSoftBody* torus : tori) support += supportOn(*torus, *m_ground) / 60;
    }
    EXPECT_NEAR(support, 60, 0.02 * 60);
    for (const btSoftBody* torus : tori)
    {
        EXPECT_NEAR(lowest(*torus), -2, 2e-3);
        EXPECT_NEAR(centerOf(*torus).y, -2 + 0.25, 0.04);  // flat on the ground, and slightly compressed
        EXPECT_LT(fastestNode(*torus), 0.5);
        EXPECT_GT(smallestVolumeRatio(*torus), 0.7);
    }
    EXPECT_LT(book.made(), 1e-3 * 60 * 2.5);
    EXPECT_GT(m_flattest, 0.1);
}

// A box of 1 kg hangs and swings from two edges of a slab that is pinned at two other edges.
TEST_F(DeformableExample, AnchoredCornersCarryABox)
{
    setGravity(10);
    m_world.world().setImplicit(false);
    ExampleBlock block;
    block.m_scale = {4, btScalar(0.25), 4};
    block.m_center = {0, 6, 0};
    block.m_friction = 2;
    block.m_collisions = btSoftBody::fCollision::SDF_RD | btSoftBody::fCollision::SDF_RDF;
    btSoftBody& slab = addBlock(makeBox({2, 2, 2}, {8, 1, 8}, {-1, -1, -1}), block);
    addGravity(slab);
    addElasticity(slab, 1000);
    btRigidBody& box = addRigidBox({4, 1, 3}, {0, 6, btScalar(-7.5)}, 1);
    std::vector<std::pair<int, btVector3>> pinned;
    for (int i = 0; i < slab.m_nodes.size(); ++i)
    {
        const btVector3 x = slab.m_nodes[i].m_x;
        if (std::fabs(x.x()) < 3.99 || std::fabs(x.z()) < 3.99) continue;
        if (x.z() < 0) slab.appendDeformableAnchor(i, &box);
        if (x.z() > 0) slab.setMass(i, 0), pinned.push_back({i, x});
    }
    EnergyBook book(fem(), m_gravity);
    book.addSoft(slab, 1000, 0.3);
    book.addRigid(box);
    book.open();
    Vec3 momentum;
    double error = 0;
    for (int k = 0; k < 600; ++k)
    {
        run(book, 1, 1.0 / 240);
        const auto& anchors = fem().anchors(&slab);
        ASSERT_EQ(anchors.size(), 4);
        momentum += (1 / 240.0) * m_gravity;
        for (int a = 0; a < 4; ++a)
        {
            momentum -= vec3(anchors[a].m_impulse);
            error = std::max(error, double(anchors[a].m_error));
        }
    }
    EXPECT_LT(error, 2e-3);  // of a swing of ten metres; without the anchors it would fall 31 m
    EXPECT_GT(centerOf(slab).y, -2);
    EXPECT_LT(norm(motionOf(box).m_linear - momentum), 1e-3 * 10);
    EXPECT_GT(box.getCenterOfMassPosition().z(), 5);  // it swung through to the other side
    EXPECT_LT(book.made(), 1e-3 * 10 * 6);
    EXPECT_GT(m_flattest, 0.3);
    EXPECT_NEAR(box.getCenterOfMassPosition().x(), 0, 0.05);
    for (const auto& [node, place] : pinned) EXPECT_EQ(slab.m_nodes[node].m_x, place);
}

}  // namespace
}  // namespace bullet_fem

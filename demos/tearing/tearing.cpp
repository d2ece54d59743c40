// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// A loaf of bread, divided into Voronoi cells that are welded together, is pulled apart by two grips.
#include <algorithm>
#include <memory>
#include <set>
#include <utility>

#include "bullet_fem/btFemHelpers.h"
#include "bullet_fem/btFemWelds.h"
#include "bullet_fem/fem/mesh/generators.h"
#include "demos/common/demo.h"
#include "demos/common/demo_measures.h"
#include "demos/common/demo_world.h"

namespace
{
using namespace bullet_fem;

constexpr double kLength = 0.36, kWidth = 0.13, kHeight = 0.12, kUp = 0.16;  // size and initial height of the loaf [m]
constexpr double kHand = 0.02, kDensity = 250;           // half thickness of a grip [m], density of bread [kg/m3]
constexpr double kRest = 0.4, kPull = 1.6, kLast = 3.5;  // start and duration of pulling, time of final rest [s]

/// A box with an arched top.
TetMesh loaf()
{
    const TetMesh box = makeBox({kLength, 1, 2}, {12, 4, 4}, {-kLength / 2, 0, -1});
    std::vector<Vec3> X = box.restPositions();
    for (Vec3& x : X)
        x = {x.x, kUp + kHeight * x.y * (1 - 0.25 * x.z * x.z), kWidth / 2 * x.z * (1 - 0.25 * x.y * x.y)};
    return TetMesh(std::move(X), box.tets());
}

/// True if welds connect both bodies, directly or through others.
bool hangTogether(const btFemSoftBodySolver& fem, const std::vector<btFemPiece>& pieces, const btSoftBody* const ends[])
{
    std::set<const btSoftBody*> reached = {ends[0]};
    btAlignedObjectArray<btFemWeldReport> welds;
    for (std::size_t before = 0; std::exchange(before, reached.size()) < reached.size();)
        for (const btFemPiece& piece : pieces)
            for (int w = btFemWelds::welds(fem, piece.m_body, welds) ? welds.size() - 1 : -1; w >= 0; --w)
                if (reached.count(welds[w].m_a) + reached.count(welds[w].m_b) > 0)
                    reached.insert({welds[w].m_a, welds[w].m_b});
    return reached.count(ends[1]) > 0;
}

void play(Demo& demo, double young, double strength, double speed)
{
    DemoWorld world;
    world.addGround();
    const std::unique_ptr<btSoftBody> whole(btFemHelpers::createFromTetMesh(world.info(), loaf()));
    std::vector<int> labels;
    std::vector<btFemPiece> pieces;
    btFemPieces::voronoiLabels(whole.get(), 16, 4, labels);
    btFemPieces::cut(whole.get(), labels, pieces);
    btFemMaterial crumb;
    crumb.m_youngModulus = btScalar(young);
    crumb.m_density = btScalar(kDensity);
    const auto handAt = [](int right, double way)
    { return at((2 * right - 1) * (kLength / 2 + kHand + way), kUp + kHeight / 2, 0); };
    btRigidBody* hands[2];
    for (const int right : {0, 1})
    {
        hands[right] = &world.addRigid(new btBoxShape(at(kHand, 0.08, 0.09)), 0, handAt(right, 0));
        hands[right]->setCollisionFlags(btCollisionObject::CF_KINEMATIC_OBJECT);
        hands[right]->setActivationState(DISABLE_DEACTIVATION);
    }
    const btSoftBody* ends[2] = {nullptr, nullptr};
    double pull = 0, torn = -1, held = 0, mass = 0;
    for (const btFemPiece& piece : pieces)
    {
        mass += massOf(world.addSoft(piece.m_body, crumb, 0.6));
        demo.paint(*piece.m_body, {0.80 - 0.05 * (piece.m_label % 3), 0.58 - 0.05 * (piece.m_label % 3), 0.33});
        for (int i = 0; i < piece.m_body->m_nodes.size(); ++i)
        {
            const double x = piece.m_body->m_nodes[i].m_x.x();
            if (std::abs(x) < 0.499 * kLength) continue;
            piece.m_body->appendAnchor(i, hands[x > 0], true);
            ends[x > 0] = piece.m_body;
        }
    }
    btFemWeldStrength weld;
    weld.m_breakStress = btScalar(strength);
    demo.figure("welds", btFemWelds::weldPieces(world.fem(), pieces, weld), "");
    demo.look(at(0.27, 0.48, 0.85), at(0, 0.18, 0));
    while (demo.step(world.bullet()))
    {
        const double way = speed * std::clamp(demo.time() - kRest, 0.0, kPull);
        for (const int right : {0, 1}) hands[right]->getWorldTransform().setOrigin(handAt(right, way));
        double force = 0;
        for (const btFemPiece& piece : pieces)
            for (int k = 0; k < world.fem().anchors(piece.m_body).size(); ++k)
            {
                const btFemAnchorReport& anchor = world.fem().anchors(piece.m_body)[k];
                if (anchor.m_object == hands[1]) force += double(anchor.m_impulse.x()) / kDemoStep;
                if (demo.time() > kLast) held += double(anchor.m_impulse.y());  // impulses of welds cancel in the sum
            }
        pull = std::max(pull, force);
        if (torn < 0 && !hangTogether(world.fem(), pieces, ends)) torn = demo.time() - kRest;
    }
    const double bears = strength * mass / kDensity / kLength;  // strength of a cross-section [N]
    demo.check("torn in two after", torn, 0.1, kPull, "s", kRest + kPull);
    demo.check("largest pull / what a section bears", pull / bears, 0.4, 1.1, "", kRest + kPull);
    demo.check("force of the hands / weight", held / (demo.time() - kLast) / (mass * kGravity), 0.98, 1.02, "", 4);
}

}  // namespace

int main(int argc, char** argv)
{
    Demo demo("tearing", "A loaf of bread, divided into cells that are welded together, is pulled apart.", 4);
    double young = 4e4, strength = 4e3, speed = 0.07;
    demo.option("--young", young, 1e3, 1e9, "Young's modulus of the bread [Pa]");
    demo.option("--strength", strength, 1, 1e9, "stress at which it tears [Pa]");
    demo.option("--speed", speed, 0, 10, "speed of each grip [m/s]");
    return demo.run(argc, argv, [&] { play(demo, young, strength, speed); });
}

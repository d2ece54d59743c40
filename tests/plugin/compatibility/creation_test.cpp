// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include <gtest/gtest.h>

#include <cstdio>
#include <functional>

#include "BulletSoftBody/btSoftBodyHelpers.h"
#include "bullet_fem/btFemHelpers.h"
#include "bullet_fem/btFemSoftBodySolver.h"
#include "bullet_fem/btFemVectors.h"
#include "bullet_fem/fem/mesh/generators.h"
#include "plugin/scenes/each_world.h"
#include "plugin/scenes/scene_measures.h"
#include "plugin/scenes/soft_boxes.h"
#include "plugin/scenes/tetgen_text.h"

namespace bullet_fem
{
namespace
{

TetMesh barMesh()
{
    return makeBox({1.2, .4, .4}, {6, 2, 2}, {0, 0, 1});
}

// --- Ways to create a body ---

btSoftBody* fromTetGen(SoftWorld& world, const TetMesh& mesh, bool links)
{
    const TetGenText text(mesh);
    return btSoftBodyHelpers::CreateFromTetGenData(world.info(), text.m_elements.c_str(), nullptr, text.m_nodes.c_str(),
                                                   false, links, false);
}

btSoftBody* fromVtk(SoftWorld& world, const TetMesh& mesh)
{
    const std::string path = testing::TempDir() + "creation_test.vtk";
    std::FILE* file = std::fopen(path.c_str(), "w");
    std::fprintf(file, "# vtk DataFile Version 2.0\nbar\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS %d double\n",
                 mesh.nodeCount());
    for (const Vec3& X : mesh.restPositions()) std::fprintf(file, "%.9g %.9g %.9g\n", X.x, X.y, X.z);
    std::fprintf(file, "CELLS %d %d\n", mesh.tetCount(), 5 * mesh.tetCount());
    for (const Tet& t : mesh.tets()) std::fprintf(file, "4 %d %d %d %d\n", t[0], t[1], t[2], t[3]);
    std::fprintf(file, "CELL_TYPES %d\n", mesh.tetCount());
    for (int e = 0; e < mesh.tetCount(); ++e) std::fprintf(file, "10\n");
    std::fclose(file);
    return btSoftBodyHelpers::CreateFromVtkFile(world.info(), path.c_str());
}

// As in Panda3D: without a call of initializeDmInverse.
btSoftBody* byHand(SoftWorld& world, const TetMesh& mesh, bool turned)
{
    auto* body = new btSoftBody(&world.info());
    body->appendMaterial();
    for (const Vec3& X : mesh.restPositions()) body->appendNode(bulletVector(X), 1);
    for (int e = 0; e < mesh.tetCount(); ++e)
    {
        const Tet& t = mesh.tets()[e];
        if (turned && e % 3 == 0)
            body->appendTetra(t[1], t[0], t[2], t[3]);
        else
            body->appendTetra(t[0], t[1], t[2], t[3]);
    }
    return body;
}

struct Way
{
    const char* m_name;
    std::function<btSoftBody*(SoftWorld&, const TetMesh&)> m_make;
    int m_flags = 0;
};

/// Adds a bar clamped at one end, which bends under its weight.
btSoftBody& addBar(SoftWorld& world, btFemSoftBodySolver& fem, btSoftBody* body)
{
    btFemMaterial material;
    material.m_youngModulus = btScalar(5e5);
    material.m_density = 1000;
    fem.setMaterial(body, material);
    for (int i = 0; i < body->m_nodes.size(); ++i)
        if (body->m_nodes[i].m_x.x() < btScalar(1e-3)) body->setMass(i, 0);
    return world.addSoft(body);
}

double largestDistance(const btSoftBody& a, const btSoftBody& b)
{
    double largest = 0;
    for (int i = 0; i < a.m_nodes.size(); ++i)
        largest = std::max(largest, double((a.m_nodes[i].m_x - b.m_nodes[i].m_x).length()));
    return largest;
}

class Creator : public EachWorldWith<Way>
{
};

class Creation : public EachWorld
{
};

INSTANTIATE_TEST_SUITE_P(Worlds, Creation, eachWorld(), nameOfWorld);

TEST_P(Creator, MakesTheSameBodyAsOurHelpers)
{
    FemWorld world(worldClass());
    btFemSoftBodySolver& fem = world.fem();
    btSoftBody& ours = addBar(world, fem, btFemHelpers::createFromTetMesh(world.info(), barMesh()));
    btSoftBody& theirs = addBar(world, fem, value().m_make(world, barMesh()));
    EXPECT_NEAR(massOf(theirs), massOf(ours), 1e-5 * massOf(ours));
    const std::vector<Vec3> rest = edgesOf(ours);
    world.step(60);
    EXPECT_TRUE(fem.isFem(&theirs));
    EXPECT_EQ(fem.stepReport(&theirs).m_flags, value().m_flags);
    const double bent = largestDifference(rest, edgesOf(ours));
    EXPECT_GT(bent, 0.04);
    EXPECT_LT(largestDistance(ours, theirs), 2e-3 * bent);  // two solves to a tolerance of 1e-3
    EXPECT_EQ(theirs.m_faces.size(), ours.m_faces.size());
}

INSTANTIATE_TEST_SUITE_P(
    Creation, Creator,
    testing::Combine(
        eachWorld(),
        testing::Values(Way{"createFromTetGenData", [](auto& w, auto& m) { return fromTetGen(w, m, false); }},
                        Way{"createFromTetGenDataWithLinks", [](auto& w, auto& m) { return fromTetGen(w, m, true); }},
                        Way{"createFromVtkFile", [](auto& w, auto& m) { return fromVtk(w, m); }},
                        Way{"appendNodeAndAppendTetra", [](auto& w, auto& m) { return byHand(w, m, false); }},
                        Way{"appendTetraOfNegativeOrientation", [](auto& w, auto& m) { return byHand(w, m, true); },
                            BT_FEM_TURNED_TETS})),
    nameOfWorldWith([](const Way& way) { return way.m_name; }));

// --- Faces ---

TEST_P(Creation, FacesAreMadeOutwardIfTheCreatorMadeNone)
{
    FemWorld world(GetParam(), btVector3(0, 0, 0));
    const TetMesh mesh = barMesh();
    btSoftBody& body = world.addSoft(byHand(world, mesh, true));
    ASSERT_EQ(body.m_faces.size(), 0);
    body.m_cfg.aeromodel = btSoftBody::eAeroModel::F_TwoSided;
    body.m_cfg.kDG = btScalar(0.5);
    body.setWindVelocity(btVector3(20, 0, 0));
    body.setVelocity(btVector3(0, 1, 0));  // Bullet limits wind on a node to the impulse that stops it
    world.step();
    EXPECT_EQ(body.m_faces.size(), static_cast<int>(mesh.surface().size()));
    EXPECT_NEAR(body.getVolume(), mesh.volume(), 1e-5 * mesh.volume());  // by the divergence theorem: outward
    for (int f = 0; f < body.m_faces.size(); ++f) EXPECT_NEAR(body.m_faces[f].m_normal.length(), 1, 1e-5);
    world.step(5);
    EXPECT_GT(velocityOf(body).x, 1e-3);  // wind acts on the faces
}

TEST_P(Creation, FacesThatExistAreLeftAlone)
{
    FemWorld world(GetParam(), btVector3(0, 0, 0));
    btFemSoftBodySolver& fem = world.fem();
    btSoftBody* made = byHand(world, barMesh(), false);
    made->appendFace(3, 1, 0);  // one face alone, in any orientation
    btSoftBody& body = world.addSoft(made);
    world.step(3);
    ASSERT_EQ(body.m_faces.size(), 1);
    EXPECT_EQ(body.m_faces[0].m_n[0], &body.m_nodes[3]);
    EXPECT_TRUE(fem.isFem(&body));
}

// --- Nodes that no element uses ---

btSoftBody* makeWithUnusedNodes(SoftWorld& world)
{
    btSoftBody* body = byHand(world, barMesh(), false);
    auto* with = new btSoftBody(&world.info());
    with->appendMaterial();
    with->appendNode(btVector3(-3, 0, 5), 7);  // before and after the used nodes
    for (int i = 0; i < body->m_nodes.size(); ++i) with->appendNode(body->m_nodes[i].m_x, 1);
    with->appendNode(btVector3(9, 0, 5), 0);
    with->appendNode(btVector3(5, 5, 5), 1);
    const auto index = [&](const btSoftBody::Node* node) { return int(node - &body->m_nodes[0]) + 1; };
    for (int e = 0; e < body->m_tetras.size(); ++e)
    {
        const btSoftBody::Tetra& t = body->m_tetras[e];
        with->appendTetra(index(t.m_n[0]), index(t.m_n[1]), index(t.m_n[2]), index(t.m_n[3]));
    }
    delete body;
    return with;
}

TEST_P(Creation, UnusedNodesStandStillAndTheBodyMovesAsWithoutThem)
{
    FemWorld world(GetParam());
    btFemSoftBodySolver& fem = world.fem();
    world.addPlane();
    btSoftBody& plain = world.addSoft(byHand(world, barMesh(), false));
    btSoftBody& body = world.addSoft(makeWithUnusedNodes(world));
    for (btSoftBody* b : {&plain, &body}) b->m_cfg.collisions = btSoftBody::fCollision::SDF_RS;
    body.setVelocity(btVector3(1, 0, 0));  // of the used nodes alone
    plain.setVelocity(btVector3(1, 0, 0));
    const int last = body.m_nodes.size() - 1;
    const btVector3 places[] = {body.m_nodes[0].m_x, body.m_nodes[last - 1].m_x, body.m_nodes[last].m_x};
    world.step(180);
    const int fallen = BT_FEM_INSIDE_OUT;  // it fell on some elements
    EXPECT_EQ(fem.stepReport(&body).m_flags & ~fallen,
              (fem.stepReport(&plain).m_flags & ~fallen) | BT_FEM_UNUSED_NODES);
    EXPECT_EQ(body.m_nodes[0].m_x, places[0]);
    EXPECT_EQ(body.m_nodes[last - 1].m_x, places[1]);
    EXPECT_EQ(body.m_nodes[last].m_x, places[2]);
    double furthest = 0;
    for (int i = 0; i < plain.m_nodes.size(); ++i)
        furthest = std::max(furthest, double((plain.m_nodes[i].m_x - body.m_nodes[i + 1].m_x).length()));
    EXPECT_LT(furthest, 1e-5);
    EXPECT_NEAR(impulseOn(fem, body).z, impulseOn(fem, plain).z, 1e-3 * impulseOn(fem, plain).z);  // of equal weight

    body.translate(btVector3(0, 0, 3));  // moves the unused nodes, too
    world.step();
    EXPECT_LT((body.m_nodes[0].m_x - places[0] - btVector3(0, 0, 3)).length(), 1e-5);
    body.m_nodes[0].m_x.setY(2);  // they stay where they are written
    world.step();
    EXPECT_NEAR(body.m_nodes[0].m_x.y(), 2, 1e-6);
}

// Each detail level warps its factor by other rotations.
TEST_P(Creation, UnusedNodesDoNoHarmInAnyDetailOrPrecision)
{
    for (const btScalar tolerance : {btScalar(1e-3), btScalar(1e-6)})
        for (const btFemDetail detail : {btFemDetail::nodalWarp, btFemDetail::globalWarp, btFemDetail::direct})
        {
            btFemSolverInfo info;
            info.m_tolerance = tolerance;
            FemWorld world(GetParam(), info);
            btFemSoftBodySolver& fem = world.fem();
            btSoftBody& body = world.addSoft(makeWithUnusedNodes(world));
            fem.setDetail(&body, detail);
            world.step(30);
            EXPECT_TRUE(fem.isFem(&body));
            EXPECT_TRUE(allFinite(body));
            EXPECT_NEAR(body.m_nodes[4].m_v.z(), -kGravity * 30 * kStep, 1e-3);
        }
}

TEST_P(Creation, UnusedNodesGetNoMassFromADensity)
{
    FemWorld world(GetParam());
    btFemSoftBodySolver& fem = world.fem();
    btSoftBody& body = world.addSoft(makeWithUnusedNodes(world));
    btFemMaterial material;
    material.m_density = 1000;
    fem.setMaterial(&body, material);
    world.step();
    EXPECT_EQ(fem.stepReport(&body).m_flags, BT_FEM_UNUSED_NODES);
    EXPECT_NEAR(body.getTotalMass(), 192 + 7 + 1, 0.01);  // the unused nodes' masses are kept
}

TEST_P(Creation, HelpersRejectUnusedNodes)
{
    FemWorld world(GetParam());
    const btVector3 x[] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {5, 5, 5}};
    const int tet[] = {0, 1, 2, 3};
    EXPECT_THROW(btFemHelpers::createFromTetMesh(world.info(), x, 5, tet, 1), std::invalid_argument);
}

// --- Links of FEM bodies ---

// The material gives the stiffness: link springs, whose stiffness depends on the step and the iterations, add nothing.
TEST_P(Creation, LinksAreIgnoredBitForBit)
{
    FemWorld world(GetParam());
    btFemSoftBodySolver& fem = world.fem();
    btSoftBody& plain = addBar(world, fem, fromTetGen(world, barMesh(), false));
    btSoftBody& body = addBar(world, fem, fromTetGen(world, barMesh(), true));
    const int links = body.m_links.size();
    ASSERT_GT(links, 0);
    body.generateBendingConstraints(2);
    EXPECT_GT(body.m_links.size(), links);
    body.randomizeConstraints();
    body.appendLink(0, body.m_nodes.size() - 1);
    body.m_cfg.piterations = 20;
    world.step(30);
    body.appendLink(1, body.m_nodes.size() - 2);  // during the run
    body.randomizeConstraints();
    world.step(30);
    EXPECT_TRUE(fem.isFem(&body));
    EXPECT_EQ(fem.stepReport(&body).m_flags, 0);
    EXPECT_EQ(bitsOf(plain), bitsOf(body));
}

}  // namespace
}  // namespace bullet_fem

// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "bullet_bridge/body/split_soft_body.h"

#include <algorithm>
#include <utility>

#include "BulletSoftBody/btSoftBody.h"
#include "bullet_bridge/body/body_arrays.h"
#include "bullet_bridge/body/face_tree.h"
#include "bullet_bridge/body/rigid_dispatch.h"
#include "bullet_fem/bullet_bridge/vectors.h"

namespace bullet_fem
{
namespace
{

/// A side of an element on the surface before the split.
struct BoundarySide
{
    Triangle m_sorted;  // its nodes before the split, ascending
    int m_tet;
    bool operator<(const BoundarySide& b) const { return m_sorted < b.m_sorted; }
};

Triangle outwardSide(const Tet& tet, int a)
{
    Triangle side = {tet[(a + 1) % 4], tet[(a + 2) % 4], tet[(a + 3) % 4]};
    if (a % 2 != 0) std::swap(side[1], side[2]);  // orient outward
    return side;
}

Triangle sortedSide(Triangle nodes)
{
    std::sort(nodes.begin(), nodes.end());
    return nodes;
}

int nodeAfter(const TetMesh& before, const TetMesh& after, int tet, int node)
{
    const Tet& nodes = before.tets()[tet];
    return after.tets()[tet][std::find(nodes.begin(), nodes.end(), node) - nodes.begin()];
}

int nodeNumber(const btSoftBody& soft, const btSoftBody::Node* node)
{
    return static_cast<int>(node - &soft.m_nodes[0]);
}

void appendCopies(btSoftBody& soft, const std::vector<int>& copyOf)
{
    for (int original : copyOf)
    {
        soft.appendNode(soft.m_nodes[original].m_x, 1);
        btSoftBody::Node& copy = soft.m_nodes[soft.m_nodes.size() - 1];
        btDbvtNode* leaf = copy.m_leaf;
        copy = soft.m_nodes[original];
        copy.m_leaf = leaf;
        copy.m_battach = 0;  // Bullet's anchors stay on the original node
        copy.index = soft.m_nodes.size() - 1;
    }
}

void joinTetras(btSoftBody& soft, const TetMesh& before, const TetMesh& after)
{
    for (int e = 0; e < soft.m_tetras.size(); ++e)
        for (btSoftBody::Node*& node : soft.m_tetras[e].m_n)
            node = &soft.m_nodes[nodeAfter(before, after, e, nodeNumber(soft, node))];
}

// Attaches existing faces to their elements, then appends the crack surfaces.
void joinFaces(btSoftBody& soft, const TetMesh& before, const TetMesh& after)
{
    const std::vector<unsigned char> sidesBefore = before.boundarySides(), sides = after.boundarySides();
    std::vector<BoundarySide> boundary;
    for (int e = 0; e < before.tetCount(); ++e)
        for (int a = 0; a < 4; ++a)
            if (sidesBefore[e] >> a & 1) boundary.push_back({sortedSide(outwardSide(before.tets()[e], a)), e});
    std::sort(boundary.begin(), boundary.end());
    for (int f = 0; f < soft.m_faces.size(); ++f)
    {
        btSoftBody::Node** nodes = soft.m_faces[f].m_n;
        const Triangle was = {nodeNumber(soft, nodes[0]), nodeNumber(soft, nodes[1]), nodeNumber(soft, nodes[2])};
        const BoundarySide side = {sortedSide(was), -1};
        const auto at = std::lower_bound(boundary.begin(), boundary.end(), side);
        if (at == boundary.end() || side < *at) continue;  // a user's face inside of the body
        for (int a = 0; a < 3; ++a) nodes[a] = &soft.m_nodes[nodeAfter(before, after, at->m_tet, was[a])];
    }
    for (int e = 0; e < after.tetCount(); ++e)
        for (int a = 0; a < 4; ++a)
        {
            if (!(sides[e] >> a & 1) || (sidesBefore[e] >> a & 1)) continue;
            const Triangle side = outwardSide(after.tets()[e], a);
            soft.appendFace(side[0], side[1], side[2]);
        }
}

template <class T>
void appendCopies(std::vector<T>& ofNodes, const std::vector<int>& copyOf)
{
    for (int original : copyOf)
    {
        const T copy = ofNodes[original];
        ofNodes.push_back(copy);
    }
}

}  // namespace

void splitSoftBody(FemSoftBody& fem, const SplitMesh& split, const std::vector<double>& mass,
                   const std::shared_ptr<const BodyModel>& model, std::shared_ptr<ComplianceCache> compliance)
{
    btSoftBody& soft = *fem.m_softBody;
    const std::vector<int>& copyOf = split.m_copyOf;
    const std::shared_ptr<const BodyModel> former = fem.m_body.m_model;
    const TetMesh &before = former->mesh(), &after = model->mesh();
    clearBulletContacts(soft);
    appendCopies(soft, copyOf);
    followNodes(fem);
    joinTetras(soft, before, after);
    joinFaces(soft, before, after);
    fem.m_body = splitBody(fem.m_body, model, copyOf);
    fem.m_body.m_state.m_mass = mass;  // the model's masses may be those of a copy elsewhere
    appendCopies(fem.m_written.m_x, copyOf);
    appendCopies(fem.m_written.m_v, copyOf);
    appendCopies(fem.m_written.m_inverseMass, copyOf);
    appendCopies(fem.m_pins.m_velocity, copyOf);
    appendCopies(fem.m_pins.m_position, copyOf);
    appendCopies(fem.m_pins.m_hasTarget, copyOf);
    appendCopies(fem.m_pins.m_moved, copyOf);
    for (int i = 0; i < soft.m_nodes.size(); ++i)
    {
        btScalar& inverse = soft.m_nodes[i].m_im;
        const bool isOfSplit = i >= before.nodeCount() || std::binary_search(copyOf.begin(), copyOf.end(), i);
        if (isOfSplit && inverse != 0) fem.m_written.m_inverseMass[i] = inverse = static_cast<btScalar>(1 / mass[i]);
    }
    fem.m_setUp.m_topology = TopologyMarks(soft);
    fem.m_joints.m_isWelded.clear();
    fem.m_memory.m_predicted.clear();
    fem.m_memory.m_predicted.reserve(mass.size());
    fem.setSkin(nullptr, std::move(compliance));
    keepFaceTree(soft);
    soft.updateNormals();
}

}  // namespace bullet_fem

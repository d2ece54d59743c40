// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "demos/drop_frames.h"

#include "BulletSoftBody/btSoftBody.h"

namespace bullet_fem
{
namespace
{

constexpr double kPlaneHalfSide = 2.5;  // of the square drawn, in units of the body's length

// Corners of a box are numbered by their signs, x + 2 y + 4 z; the triangles face outward.
constexpr int kBoxTriangles[12][3] = {{0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}, {0, 1, 5}, {0, 5, 4},
                                      {2, 6, 7}, {2, 7, 3}, {0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}};

Vec3 place(const btVector3& v)
{
    return {v.x(), v.y(), v.z()};
}

void appendPlane(double halfSide, std::vector<Vec3>& positions, std::vector<Triangle>& triangles)
{
    const int first = static_cast<int>(positions.size());
    for (const double z : {-halfSide, halfSide})
        for (const double x : {-halfSide, halfSide}) positions.push_back({x, 0, z});
    triangles.push_back({first, first + 2, first + 3});
    triangles.push_back({first, first + 3, first + 1});
}

void appendBox(const btRigidBody& body, std::vector<Vec3>& positions, std::vector<Triangle>& triangles)
{
    const int first = static_cast<int>(positions.size());
    const btVector3 half = static_cast<const btBoxShape*>(body.getCollisionShape())->getHalfExtentsWithMargin();
    for (int corner = 0; corner < 8; ++corner)
    {
        const btVector3 sign(corner & 1 ? 1 : -1, corner & 2 ? 1 : -1, corner & 4 ? 1 : -1);
        positions.push_back(place(body.getWorldTransform() * (half * sign)));
    }
    for (const auto& t : kBoxTriangles) triangles.push_back({first + t[0], first + t[1], first + t[2]});
}

}  // namespace

DropFrames::DropFrames(const std::string& folder, const DropScene& scene)
    : m_scene(scene), m_bodySeries(folder, "body"), m_rigidSeries(folder, "rigid")
{
    const btSoftBody& body = scene.softBody();
    for (int t = 0; t < body.m_renderFaces.size(); ++t)
    {
        Triangle triangle;
        for (int a = 0; a < 3; ++a)
            triangle[a] = static_cast<int>(body.m_renderFaces[t].m_n[a] - &body.m_renderNodes[0]);
        m_body.m_triangles.push_back(triangle);
    }
}

void DropFrames::write(double time)
{
    writeBody(time);
    writeRigid(time);
}

void DropFrames::writeBody(double time)
{
    const btSoftBody& body = m_scene.softBody();
    m_body.m_positions.clear();
    for (int i = 0; i < body.m_renderNodes.size(); ++i) m_body.m_positions.push_back(place(body.m_renderNodes[i].m_x));
    if (m_firstPositions.empty()) m_firstPositions = m_body.m_positions;

    m_body.m_displacement = m_body.m_positions;
    for (std::size_t i = 0; i < m_firstPositions.size(); ++i) m_body.m_displacement[i] -= m_firstPositions[i];
    interpolateStress();
    m_bodySeries.writeBodies(time, {m_body});
}

// Interpolates nodal stress to the vertices of the surface with their barycentric weights in elements of the cage.
void DropFrames::interpolateStress()
{
    const btSoftBody& body = m_scene.softBody();
    m_scene.getStress(m_nodeStress);
    m_body.m_nodeStress.assign(m_body.m_positions.size(), {});
    for (int i = 0; i < body.m_renderNodes.size(); ++i)
        for (int a = 0; a < body.m_renderNodesParents[i].size(); ++a)
        {
            const btFemStress& s = m_nodeStress[static_cast<int>(body.m_renderNodesParents[i][a] - &body.m_nodes[0])];
            Stress share = {s.m_xx, s.m_yy, s.m_zz, s.m_xy, s.m_yz, s.m_xz};
            m_body.m_nodeStress[i] += share *= body.m_renderNodesInterpolationWeights[i][a];
        }
}

void DropFrames::writeRigid(double time)
{
    std::vector<Vec3> positions;
    std::vector<Triangle> triangles;
    appendPlane(kPlaneHalfSide * m_scene.length(), positions, triangles);
    for (const auto& box : m_scene.boxes()) appendBox(*box, positions, triangles);
    m_rigidSeries.writeTriangles(time, positions, triangles);
}

}  // namespace bullet_fem

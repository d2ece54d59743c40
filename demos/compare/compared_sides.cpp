// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "demos/compare/compared_sides.h"

#include <algorithm>
#include <set>
#include <utility>

#include "demos/common/demo_world.h"

namespace bullet_fem
{
namespace
{

constexpr double kMadeOf = 1000;              // density used by btFemHelpers [kg/m3]
constexpr btScalar kMargin = btScalar(0.01);  // as in SoftDemo [m]

/// One side of the comparison; the sides differ in their world alone.
template <class World>
class SideOf : public ComparedSide
{
public:
    btSoftRigidDynamicsWorld& world() override { return m_world.bullet(); }
    btRigidBody& addRigid(btCollisionShape* shape, double mass, const btTransform& pose, double friction) override
    {
        return m_world.addRigid(shape, mass, pose, friction);
    }

protected:
    World m_world;
};

class FemSide : public SideOf<DemoWorld>
{
public:
    btSoftBody& addSoft(btSoftBody* body, const btFemMaterial& material, double friction) override
    {
        return m_world.addSoft(body, material, friction);
    }
};

/// Links each edge once, as btSoftBodyHelpers::CreateFromTetGenData does.
void linkEdges(btSoftBody& body)
{
    std::set<std::pair<int, int>> edges;
    for (int t = 0; t < body.m_tetras.size(); ++t)
        for (int k = 0; k < 12; ++k)
        {
            const auto node = [&](int corner) { return int(body.m_tetras[t].m_n[corner] - &body.m_nodes[0]); };
            const int a = node(k / 3), b = node((k / 3 + 1 + k % 3) % 4);
            if (a < b) edges.emplace(a, b);
        }
    for (const auto& edge : edges) body.appendLink(edge.first, edge.second);
}

class BulletSide : public SideOf<DemoBulletWorld>
{
public:
    explicit BulletSide(const SpringSettings& settings) : m_settings(settings) {}

    btSoftBody& addSoft(btSoftBody* body, const btFemMaterial& material, double friction) override
    {
        body->m_materials[0]->m_kLST = btScalar(m_settings.m_linear);
        linkEdges(*body);
        body->randomizeConstraints();
        body->setTotalMass(btScalar(body->getTotalMass() * material.m_density / kMadeOf));
        body->m_cfg.piterations = m_settings.m_iterations;
        body->m_cfg.kDF = btScalar(friction);
        body->getCollisionShape()->setMargin(kMargin);
        body->m_cfg.collisions = btSoftBody::fCollision::SDF_RS;
        if (m_settings.m_clusters > 0)
        {
            body->generateClusters(m_settings.m_clusters);
            body->m_cfg.collisions = btSoftBody::fCollision::CL_RS + btSoftBody::fCollision::CL_SS;
        }
        return m_world.addCloth(body);
    }

private:
    const SpringSettings m_settings;
};

}  // namespace

std::unique_ptr<ComparedSide> makeBulletSide(const SpringSettings& settings)
{
    return std::make_unique<BulletSide>(settings);
}

std::unique_ptr<ComparedSide> makeFemSide()
{
    return std::make_unique<FemSide>();
}

}  // namespace bullet_fem

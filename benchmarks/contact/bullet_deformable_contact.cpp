// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "benchmarks/contact/bullet_deformable_contact.h"

#include <algorithm>
#include <set>

#include "benchmarks/bullet_deformable_world.h"
#include "benchmarks/figures.h"

namespace bullet_fem
{
namespace
{

constexpr double kMarginOverCell = 0.2;  // as in Bullet's demos

/// Bullet's solver with a timer around its elastic solve.
struct TimedDeformableSolver : btDeformableBodySolver
{
    double m_seconds = 0;

    void solveDeformableConstraints(btScalar step) override
    {
        const Stopwatch watch;
        btDeformableBodySolver::solveDeformableConstraints(step);
        m_seconds += watch.seconds();
    }
};

/// Links the nodes along edges. Bullet builds its node trees along links and loops forever without them; the links
/// exert no force.
void linkEdges(btSoftBody& body, const TetMesh& mesh)
{
    std::set<std::pair<int, int>> edges;
    for (const Tet& tet : mesh.tets())
        for (int a = 0; a < 4; ++a)
            for (int b = a + 1; b < 4; ++b) edges.insert(std::minmax(tet[a], tet[b]));
    for (const auto& [i, j] : edges) body.appendLink(i, j);
}

class BulletContactWorld : public ContactWorld
{
public:
    BulletContactWorld(const ContactScene& scene, int subSteps)
        : m_subSteps(subSteps),
          m_step(scene.m_step / subSteps),
          m_margin(kMarginOverCell * scene.m_cellSize),
          m_deformable(m_solver, scene.m_gravity)
    {
        btContactSolverInfo& info = m_deformable.world().getSolverInfo();
        info.m_deformable_erp = btScalar(0.3);
        info.m_deformable_maxErrorReduction = btScalar(200);
        info.m_leastSquaresResidualThreshold = btScalar(1e-3);
        info.m_splitImpulse = true;
        info.m_numIterations = 100;

        makeBodies(scene, m_deformable.world().getWorldInfo());
        for (const auto& body : m_rigid) m_deformable.world().addRigidBody(body.get());
        for (std::size_t k = 0; k < m_soft.size(); ++k) addSoft(*m_soft[k], scene.m_soft[k].m_mesh, scene);
    }

    ~BulletContactWorld() override
    {
        for (const auto& body : m_soft) m_deformable.world().removeSoftBody(body.get());
        for (const auto& body : m_rigid) m_deformable.world().removeRigidBody(body.get());
    }

    std::string name() const override { return m_subSteps == 1 ? "bullet" : "bullet/" + std::to_string(m_subSteps); }
    double restDistance() const override { return m_margin; }

    ContactStep step() override
    {
        const Stopwatch watch;
        m_solver.m_seconds = 0;
        for (int k = 0; k < m_subSteps; ++k) m_deformable.step(m_step);
        ContactStep result;
        result.m_milliseconds = 1e3 * watch.seconds();
        result.m_cpuMilliseconds = 1e3 * watch.cpuSeconds();
        result.m_freeMilliseconds = 1e3 * m_solver.m_seconds;
        result.m_contactMilliseconds = result.m_milliseconds - result.m_freeMilliseconds;
        for (const auto& body : m_soft) addContacts(*body, result);
        return result;
    }

private:
    void addSoft(btSoftBody& body, const TetMesh& mesh, const ContactScene& scene)
    {
        linkEdges(body, mesh);
        body.getCollisionShape()->setMargin(btScalar(m_margin));
        body.m_cfg.kKHR = 1;
        body.m_cfg.kCHR = 1;
        body.m_cfg.collisions =
            btSoftBody::fCollision::SDF_RD | btSoftBody::fCollision::SDF_RDN | btSoftBody::fCollision::VF_DD;
        body.setSelfCollision(false);
        m_deformable.add(body, m_elasticity, scene.m_material);
    }

    /// Closing speed as defined for BulletFEM: violation of n . v + max(gap, 0) / h >= 0 after the step.
    void addContacts(const btSoftBody& body, ContactStep& sum) const
    {
        sum.m_contacts += body.m_nodeRigidContacts.size() + body.m_faceNodeContacts.size();
        for (int k = 0; k < body.m_nodeRigidContacts.size(); ++k)
        {
            const btSoftBody::DeformableNodeRigidContact& contact = body.m_nodeRigidContacts[k];
            const btRigidBody* rigid = btRigidBody::upcast(contact.m_cti.m_colObj);
            const btVector3 other = rigid ? rigid->getVelocityInLocalPoint(contact.m_c1) : btVector3(0, 0, 0);
            const double closing = -contact.m_cti.m_normal.dot(contact.m_node->m_v - other);
            const double allowed = std::max(0.0, double(contact.m_cti.m_offset)) / m_step;
            sum.m_closingSpeed = std::max(sum.m_closingSpeed, closing - allowed);
        }
    }

    int m_subSteps;
    double m_step, m_margin;
    TimedDeformableSolver m_solver;
    btDeformableLinearElasticityForce m_elasticity;
    BulletDeformableWorld m_deformable;
};

}  // namespace

std::unique_ptr<ContactWorld> makeBulletContactWorld(const ContactScene& scene, int subSteps)
{
    return std::make_unique<BulletContactWorld>(scene, subSteps);
}

}  // namespace bullet_fem

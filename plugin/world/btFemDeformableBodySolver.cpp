// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "bullet_fem/btFemDeformableBodySolver.h"

#include <algorithm>
#include <string>

#include "BulletCollision/CollisionDispatch/btCollisionObjectWrapper.h"
#include "bullet_bridge/body/body_arrays.h"
#include "bullet_bridge/rigid/rigid_proxies.h"
#include "bullet_fem/btFemVectors.h"
#include "fem/common/bounds.h"
#include "fem/common/reason.h"
#include "plugin/record/btFemArrays.h"
#include "plugin/record/btFemCoupling.h"
#include "plugin/registry/btFemBodyRegistry.h"
#include "plugin/setup/btFemBodySetUp.h"
#include "plugin/world/btFemDeformableForces.h"
#include "plugin/world/btFemWorldStep.h"

using namespace bullet_fem;

namespace
{

using Bodies = btAlignedObjectArray<btSoftBody*>;

// Bullet's deformable solver reads arrays that only its own file readers fill, and its search along links never ends
// without links.
bool isForBullet(const btSoftBody& body)
{
    const int tets = body.m_tetras.size();
    return tets == 0 ||
           (body.m_tetraScratches.size() >= tets && body.m_tetraScratchesTn.size() >= tets && body.m_links.size() > 0);
}

constexpr btScalar kUsualStep = btScalar(1) / 60;  // [s]; for bodies prepared in a step of invalid length

// State of a tetrahedral body.
struct Known
{
    const btSoftBody* m_body;
    int m_id;                       // broadphase id, because addresses are reused
    int m_tets;                     // former number of tetrahedra
    btFemForceMaterial m_material;  // material of the forces at the last check
    std::string m_rejection;        // reason why it was left to Bullet
};

// Hides a FEM body from the world's own loops over soft bodies.
struct Aside
{
    btSoftBody* m_body;
    int m_state, m_collisions;
};

}  // namespace

void btFemCoupling::reportRejection(btFemSoftBodySolver& fem, btSoftBody& body, const std::string& why)
{
    btFemBodyRecord& record = registry(fem).record(&body);
    if (!record.m_model.m_rejected) btFemBodySetUp::reject(record);
    record.m_model.m_message = why;
    record.m_reports.m_step = {};
    record.m_reports.m_step.m_flags = BT_FEM_REJECTED;
    record.m_reports.m_step.m_message = record.m_model.m_message.c_str();
}

struct btFemDeformableBodySolver::Impl
{
    explicit Impl(const btFemSolverInfo& info) : m_fem(info) {}

    void sort(btDeformableBodySolver& solver, const Bodies& world, btScalar dt);
    bool becomesFem(btSoftBody& body, btScalar dt);
    Known& know(const btSoftBody& body);
    void forgetRemoved(const Bodies& world);
    void reportRejections();
    void setAside();
    void takeBack();
    void drawNodes();
    void settleSleep(btScalar step);

    btFemSoftBodySolver m_fem;
    btFemDeformableForces m_forces;
    const Bodies* m_world = nullptr;  // all bodies
    Bodies m_plain;                   // bodies moved by Bullet, in the world's order
    Bodies m_ours, m_femBodies;       // all other bodies, and the FEM bodies among them
    Bodies m_reported;  // FEM bodies, as often as the world contains them, and bodies that could not become FEM
    Bodies m_femBefore, m_plainBefore;
    std::vector<Known> m_known;
    std::vector<Aside> m_aside;
    bool m_plainChanged = false;
};

Known& btFemDeformableBodySolver::Impl::know(const btSoftBody& body)
{
    const auto found = std::find_if(m_known.begin(), m_known.end(), [&](const Known& k) { return k.m_body == &body; });
    Known& known = found != m_known.end() ? *found : (m_known.push_back({}), m_known.back());
    const int id = broadphaseId(body), tets = body.m_tetras.size();
    if (known.m_body != &body || known.m_id != id || known.m_tets != tets) known = {&body, id, tets, {}, {}};
    return known;
}

void btFemDeformableBodySolver::Impl::forgetRemoved(const Bodies& world)
{
    const auto isGone = [&](const Known& k) { return !btFemHolds(world, k.m_body); };
    m_known.erase(std::remove_if(m_known.begin(), m_known.end(), isGone), m_known.end());
}

// Sets material and factor before the body becomes FEM, so that an unsuitable body stays with Bullet from the
// beginning.
bool btFemDeformableBodySolver::Impl::becomesFem(btSoftBody& body, btScalar dt)
{
    if (body.m_tetras.size() == 0) return false;
    Known& known = know(body);
    const btFemForceMaterial material = m_forces.materialOf(body);
    const btFemBodyRecord* record = btFemCoupling::record(m_fem, body);
    const bool changed = material != known.m_material;
    known.m_material = material;
    if (!material.m_given && !(record && record->m_asked.m_materialGiven) && isForBullet(body)) return false;
    const bool triedAnew = record && !record->m_model.m_rejected;  // material set by the user
    if (!known.m_rejection.empty() && !changed && !triedAnew) return false;
    try
    {
        if (changed && material.m_given) m_fem.setMaterial(&body, material.m_material);
        const btScalar step = dt * body.m_cfg.timescale;
        if (!m_fem.isFem(&body)) m_fem.prepare(&body, isUsableStep(step) ? step : kUsualStep);
        btFemCoupling::record(m_fem, body)->m_model.m_fem->m_settings.m_ownGravity = m_forces.gravityOf(body);
        known.m_rejection.clear();
        return true;
    }
    catch (const std::exception& error)
    {
        known.m_rejection = reasonOf(error);
        return m_fem.isFem(&body);  // a FEM body keeps its former material
    }
}

void btFemDeformableBodySolver::Impl::sort(btDeformableBodySolver& solver, const Bodies& world, btScalar dt)
{
    const bool inStep = dt > 0;
    m_world = &world;
    forgetRemoved(world);
    m_plainBefore.copyFromArray(m_plain);
    m_femBefore.copyFromArray(m_femBodies);
    m_plain.resizeNoInitialize(0);
    m_femBodies.resizeNoInitialize(0);
    m_ours.resizeNoInitialize(0);
    m_reported.resizeNoInitialize(0);
    for (int i = 0; i < world.size(); ++i)
    {
        btSoftBody* body = world[i];
        const bool fem = inStep ? becomesFem(*body, dt) : btFemHolds(m_femBefore, body);
        const bool plain = !fem && isForBullet(*body);
        if (plain)
            m_plain.push_back(body);
        else if (!btFemHolds(m_ours, body))  // it may have been added twice
            m_ours.push_back(body);
        if (fem && !btFemHolds(m_femBodies, body)) m_femBodies.push_back(body);
        if (fem || (body->m_tetras.size() > 0 && !know(*body).m_rejection.empty())) m_reported.push_back(body);
        if (inStep) body->setSoftBodySolver(fem ? static_cast<btSoftBodySolver*>(&m_fem) : &solver);
    }
    m_plainChanged = m_plainBefore.size() != m_plain.size();
    for (int i = 0; i < m_plain.size() && !m_plainChanged; ++i) m_plainChanged = m_plainBefore[i] != m_plain[i];
}

// Includes former FEM bodies whose elements were made invalid by the program.
void btFemDeformableBodySolver::Impl::reportRejections()
{
    for (int i = 0; i < m_reported.size(); ++i)
        if (!btFemHolds(m_femBodies, m_reported[i]))
            btFemCoupling::reportRejection(m_fem, *m_reported[i], know(*m_reported[i]).m_rejection);
}

// Bullet's deformable world lets all soft bodies that are active collide with each other, whatever their solver.
void btFemDeformableBodySolver::Impl::setAside()
{
    m_aside.clear();
    for (int i = 0; i < m_ours.size(); ++i)
    {
        btSoftBody& body = *m_ours[i];
        if (!btFemHolds(*m_world, &body)) continue;
        m_aside.push_back({&body, body.getActivationState(), body.m_cfg.collisions});
        body.forceActivationState(DISABLE_SIMULATION);
        body.m_cfg.collisions = 0;
    }
}

void btFemDeformableBodySolver::Impl::takeBack()
{
    for (const Aside& aside : m_aside)
    {
        if (!btFemHolds(*m_world, aside.m_body)) continue;
        aside.m_body->forceActivationState(aside.m_state);
        aside.m_body->m_cfg.collisions = aside.m_collisions;
    }
    m_aside.clear();
}

// Replaces the picking springs of the previous step; the user's springs have positive handles.
void btFemDeformableBodySolver::Impl::drawNodes()
{
    for (int i = 0; i < m_femBodies.size(); ++i)
    {
        const btFemBodyRecord* record = btFemCoupling::record(m_fem, *m_femBodies[i]);
        if (!record || !record->isFem()) continue;
        std::vector<NodeSpring>& springs = record->fem().m_joints.m_springs;
        const auto isDrawn = [](const NodeSpring& s) { return s.m_id < 0; };
        springs.erase(std::remove_if(springs.begin(), springs.end(), isDrawn), springs.end());
        for (const btFemDrawnNode& drawn : m_forces.drawn())
            if (drawn.m_body == m_femBodies[i]) springs.push_back(drawn.m_spring);
    }
}

// The world will add the step to the deactivation time, as m_fem has just done, and decides by that time alone, whereas
// m_fem may have reasons to keep a body awake. The world has no tolerance for short twitches, so their speed is hidden.
void btFemDeformableBodySolver::Impl::settleSleep(btScalar step)
{
    for (int i = 0; i < m_femBodies.size(); ++i)
    {
        btSoftBody& body = *m_femBodies[i];
        const btScalar time = body.getDeactivationTime();
        const int state = body.getActivationState();
        if ((state != ACTIVE_TAG && state != WANTS_DEACTIVATION) || time == 0) continue;
        const bool stays = state == ACTIVE_TAG;
        body.setDeactivationTime((stays ? std::min(time, gDeactivationTime) : time) - step);
        if (body.m_maxSpeedSquared >= body.m_sleepingThreshold * body.m_sleepingThreshold) body.m_maxSpeedSquared = 0;
    }
}

btFemDeformableBodySolver::btFemDeformableBodySolver(const btFemSolverInfo& info) : m_impl(std::make_unique<Impl>(info))
{
    setGravity(btVector3(0, -10, 0));  // Bullet's initial gravity, which the world does not pass on
}

btFemDeformableBodySolver::~btFemDeformableBodySolver() = default;

btFemSoftBodySolver& btFemDeformableBodySolver::fem()
{
    return m_impl->m_fem;
}

const btFemSoftBodySolver& btFemDeformableBodySolver::fem() const
{
    return m_impl->m_fem;
}

const char* btFemDeformableBodySolver::rejection(const btSoftBody* body) const
{
    for (const Known& known : m_impl->m_known)
        if (known.m_body == body) return known.m_rejection.c_str();
    return "";
}

btAlignedObjectArray<btDeformableLagrangianForce*>* btFemDeformableBodySolver::getLagrangianForceArray()
{
    return &m_impl->m_forces.all();
}

// Called at the start of a step, and with dt < 0 after the removal of a body.
void btFemDeformableBodySolver::reinitialize(const btAlignedObjectArray<btSoftBody*>& softBodies, btScalar dt)
{
    Impl& impl = *m_impl;
    if (dt > 0) impl.m_forces.show(softBodies);  // after a step that was not finished
    impl.sort(*this, softBodies, dt);
    if (dt > 0) impl.m_fem.optimize(impl.m_reported);
    btFemCoupling::setClothBodies(impl.m_fem, impl.m_plain);
    if (dt > 0) impl.reportRejections();
    if (dt > 0) impl.m_forces.hide(impl.m_ours, m_objective->m_lf);
    if (impl.m_plainChanged) m_numNodes = -1;  // Bullet compares their number only
    btDeformableBodySolver::reinitialize(impl.m_plain, dt);
}

void btFemDeformableBodySolver::predictMotion(btScalar solverdt)
{
    Impl& impl = *m_impl;
    impl.m_forces.addTo(impl.m_femBodies, impl.m_plain, solverdt);
    impl.drawNodes();
    if (impl.m_plain.size() > 0) btDeformableBodySolver::predictMotion(solverdt);
    impl.m_fem.predictMotion(solverdt);
}

void btFemDeformableBodySolver::processCollision(btSoftBody* body, const btCollisionObjectWrapper* other)
{
    if (btFemHolds(m_impl->m_plain, body) && hasUsableNodes(*body))
        btDeformableBodySolver::processCollision(body, other);
}

void btFemDeformableBodySolver::processCollision(btSoftBody* body, btSoftBody* other)
{
    if (m_impl->m_fem.isFem(body) != m_impl->m_fem.isFem(other)) return m_impl->m_fem.processCollision(body, other);
    const bool bullets = btFemHolds(m_impl->m_plain, body) && btFemHolds(m_impl->m_plain, other);
    if (bullets && hasUsableNodes(*body) && hasUsableNodes(*other))
        btDeformableBodySolver::processCollision(body, other);
}

// Tick callbacks may have given FEM bodies to forces since the step began.
void btFemDeformableBodySolver::setConstraints(const btContactSolverInfo& info)
{
    m_impl->m_forces.hide(m_impl->m_ours, m_objective->m_lf);
    btDeformableBodySolver::setConstraints(info);
}

void btFemDeformableBodySolver::solveDeformableConstraints(btScalar solverdt)
{
    if (m_softBodies.size() > 0) btDeformableBodySolver::solveDeformableConstraints(solverdt);
    m_impl->setAside();
}

void btFemDeformableBodySolver::applyTransforms(btScalar timeStep)
{
    Impl& impl = *m_impl;
    impl.takeBack();
    impl.m_forces.show(*impl.m_world);
    btDeformableBodySolver::applyTransforms(timeStep);
    impl.m_fem.solveConstraints(timeStep);
    impl.m_fem.updateSoftBodies();
    impl.settleSleep(timeStep);
}

void btFemDeformableBodySolver::setGravity(const btVector3& gravity)
{
    btFemCoupling::assumeForcesGiven(m_impl->m_fem, vec3(gravity));
}

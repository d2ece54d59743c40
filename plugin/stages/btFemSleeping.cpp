// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "plugin/stages/btFemSleeping.h"

#include <algorithm>

#include "BulletCollision/BroadphaseCollision/btDispatcher.h"
#include "BulletCollision/CollisionDispatch/btCollisionObjectWrapper.h"
#include "BulletSoftBody/btSoftBody.h"
#include "BulletSoftBody/btSoftBodySolvers.h"
#include "bullet_bridge/body/node_exchange.h"
#include "bullet_bridge/rigid/world_objects.h"
#include "fem/common/byte_stream.h"
#include "plugin/registry/btFemBodyRegistry.h"
#include "plugin/stages/btFemNeighbours.h"

using namespace bullet_fem;

namespace
{

// In a pile, a node occasionally slips off another body's edge and is faster than the threshold for one step. Such a
// twitch costs a few steps of the time at rest, while real motion resets it. Time at rest is accumulated beyond the
// limit, so that all of many bodies can want to sleep at once.
constexpr btScalar kTwitchSpeed = 4;                  // upper speed of a twitch over the threshold
constexpr btScalar kTwitchCostSteps = 4;              // time that a twitch costs, in steps
constexpr btScalar kReserveTime = btScalar(1.0 / 4);  // extra time at rest over gDeactivationTime

// True if the body sleeps or waits for its island to sleep.
bool isQuiet(const btFemBodyRecord& record)
{
    const int state = record.m_softBody->getActivationState();
    return state == ISLAND_SLEEPING || state == WANTS_DEACTIVATION;
}

bool isWatched(const btFemBodyRecord& record)
{
    return isQuiet(record) && record.m_work.m_sleep.m_recorded;
}

bool wokeWithinStep(const btFemBodyRecord& record)
{
    return record.m_work.m_sleep.m_asleep && record.m_softBody->isActive();
}

bool nodesWritten(const FemSoftBody& fem)
{
    const WrittenNodes& written = fem.m_written;
    for (int i = 0; i < fem.m_softBody->m_nodes.size(); ++i)
    {
        const btSoftBody::Node& node = fem.m_softBody->m_nodes[i];
        // Compares components, as btVector3's == includes the fourth, which has no meaning here.
        for (int c = 0; c < 3; ++c)
            if (node.m_x[c] != written.m_x[i][c] || node.m_v[c] != written.m_v[i][c]) return true;
        if (node.m_im != written.m_inverseMass[i]) return true;
    }
    return false;
}

bool forcesGiven(const btSoftBody& soft)
{
    for (int i = 0; i < soft.m_nodes.size(); ++i)
        for (int c = 0; c < 3; ++c)
            if (soft.m_nodes[i].m_f[c] != 0) return true;
    return false;
}

std::uint64_t markOfForces(const btSoftBody& soft)
{
    std::uint64_t mark = kEmptyMark;
    for (int i = 0; i < soft.m_nodes.size(); ++i)
        for (int c = 0; c < 3; ++c) addToMark(mark, soft.m_nodes[i].m_f[c]);
    return mark;
}

std::uint64_t markOfTargets(const FemSoftBody& fem)
{
    const NodePins& pins = fem.m_pins;
    std::uint64_t mark = kEmptyMark;
    addToMark(mark, fem.m_body.m_state.m_initialStressChanges);
    for (const Chamber& c : fem.m_body.m_actuators.m_chambers)
        for (const double value : {double(c.m_id), double(c.m_isSealed), c.m_pressure, c.m_gas, c.m_outsidePressure})
            addToMark(mark, value);
    for (const Cable& c : fem.m_body.m_actuators.m_cables)
        for (const double value : {double(c.m_id), c.m_tension, c.m_stiffness, c.m_restLength}) addToMark(mark, value);
    for (const NodeSpring& spring : fem.m_joints.m_springs)
    {
        addToMark(mark, spring.m_id);
        for (int c = 0; c < 3; ++c) addToMark(mark, spring.m_target[c]);
    }
    for (std::size_t i = 0; i < pins.m_hasTarget.size(); ++i)
    {
        if (!pins.m_hasTarget[i]) continue;
        addToMark(mark, i);
        for (int c = 0; c < 3; ++c) addToMark(mark, pins.m_position[i][c]);
    }
    return mark;
}

btFemInfluences influencesOn(const FemSoftBody& fem)
{
    const btSoftBody& soft = *fem.m_softBody;
    const btSoftBodyWorldInfo* info = soft.m_worldInfo;
    const Vec3 gravity = fem.gravity();
    const btVector3 wind = const_cast<btSoftBody&>(soft).getWindVelocity();
    const btSoftBody::Config& cfg = soft.m_cfg;
    return {gravity.x,
            gravity.y,
            gravity.z,
            wind.x(),
            wind.y(),
            wind.z(),
            info ? double(info->air_density) : 0,
            double(cfg.aeromodel),
            cfg.kDG,
            cfg.kLF,
            cfg.kPR,
            cfg.kVC,
            soft.m_pose.m_bframe ? double(cfg.kMT) : 0,
            cfg.kDF,
            cfg.kCHR,
            cfg.kKHR,
            cfg.kSHR,
            soft.getRestitution(),
            double(soft.hasContactResponse()),
            double(cfg.collisions),
            double(soft.m_anchors.size()),
            double(soft.m_deformableAnchors.size()),
            double(soft.m_joints.size()),
            double(fem.m_joints.m_attachments.size() + fem.m_joints.m_clothAttachments.size()),
            fem.m_settings.m_contactOffset};
}

// True if an influence on the body has changed since the end of the last step.
bool isChanged(const btFemBodyRecord& record)
{
    const FemSoftBody& fem = record.fem();
    return record.m_asked.m_materialChanged || nodesWritten(fem) || restMatricesChanged(fem) ||
           forcesGiven(*fem.m_softBody) || markOfTargets(fem) != record.m_work.m_sleep.m_targets ||
           influencesOn(fem) != record.m_work.m_sleep.m_influences;
}

// Squared speed of the fastest node. Displacement over step counts, too, because penetration is corrected without a
// velocity.
double fastestSquared(const btFemBodyRecord& record)
{
    const FemSoftBody& fem = record.fem();
    btScalar fastest = 0, longest = 0;
    for (int i = 0; i < fem.m_softBody->m_nodes.size(); ++i)
    {
        const btSoftBody::Node& node = fem.m_softBody->m_nodes[i];
        fastest = std::max(fastest, node.m_v.length2());
        longest = std::max(longest, (node.m_x - node.m_q).length2());
    }
    return std::max(double(fastest), longest / (record.m_work.m_lastStep * record.m_work.m_lastStep));
}

// True if the user gave a pinned node a velocity: it moves, however slowly.
bool isDriven(const FemSoftBody& fem)
{
    for (std::size_t i = 0; i < fem.m_pins.m_velocity.size(); ++i)
    {
        const bool byVelocity = fem.m_body.m_state.m_fixed[i] && !fem.m_pins.m_hasTarget[i];
        if (byVelocity && dot(fem.m_pins.m_velocity[i], fem.m_pins.m_velocity[i]) > 0) return true;
    }
    return false;
}

// Zeroes the costs of a step; contacts are kept.
void clearCost(btFemStepReport& report)
{
    report.m_iterations = report.m_contactIterations = report.m_contactSweeps = 0;
    report.m_freeMotionMs = report.m_contactMs = 0;
    report.m_tooSlow = false;
}

void fallAsleep(btFemBodyRecord& record)
{
    FemSoftBody& fem = record.fem();
    // Tick callbacks may write after the step of an active body was prepared.
    if (nodesWritten(fem) || markOfForces(*fem.m_softBody) != record.m_work.m_sleep.m_forces)
    {
        fem.m_softBody->activate();
        return;
    }
    std::fill(fem.m_body.m_state.m_v.begin(), fem.m_body.m_state.m_v.end(), Vec3());
    writeNodes(fem);
    for (int i = 0; i < fem.m_softBody->m_nodes.size(); ++i) fem.m_softBody->m_nodes[i].m_f.setZero();
    clearCost(record.m_reports.m_step);
    record.m_work.m_sleep.m_asleep = true;
}

// btSoftBody::updateDeactivation with a tolerance for twitches.
void updateTimeAtRest(btSoftBody& soft, btScalar step)
{
    if (soft.getActivationState() == DISABLE_DEACTIVATION) return;
    const btScalar threshold = soft.m_sleepingThreshold * soft.m_sleepingThreshold;
    const btScalar time = soft.getDeactivationTime();
    if (soft.m_maxSpeedSquared < threshold)
    {
        soft.setDeactivationTime(time + step);
        return;
    }
    const bool twitches = soft.m_maxSpeedSquared < kTwitchSpeed * kTwitchSpeed * threshold;
    const btScalar left = std::min(time, (1 + kReserveTime) * gDeactivationTime) - kTwitchCostSteps * step;
    soft.setDeactivationTime(twitches ? std::max(left, btScalar(0)) : 0);
    if (!(soft.getDeactivationTime() > gDeactivationTime)) soft.setActivationState(ACTIVE_TAG);
}

// btDiscreteDynamicsWorld::updateActivationState for FEM bodies.
void updateActivation(WorldObjects& world, btFemBodyRecord& record)
{
    btSoftBody& soft = *record.m_softBody;
    if (soft.getActivationState() == DISABLE_SIMULATION) return;
    if (soft.isActive() && record.m_work.m_lastStep > 0 && (record.m_reports.m_step.m_flags & BT_FEM_BAD_STEP) == 0)
    {
        const bool staysAwake = isDriven(record.fem()) || record.m_work.m_sleep.m_enclosesObject;
        const double threshold = staysAwake ? double(soft.m_sleepingThreshold) : 0;
        soft.m_maxSpeedSquared =
            static_cast<btScalar>(std::max(record.m_work.m_sleep.m_fastestSquared, threshold * threshold));
        updateTimeAtRest(soft, static_cast<btScalar>(record.m_work.m_lastStep));
    }
    if (!soft.wantsSleeping())
        soft.setActivationState(ACTIVE_TAG);
    else if (soft.getActivationState() == ACTIVE_TAG && !holdsMovingObject(world, record))
        soft.setActivationState(WANTS_DEACTIVATION);
}

}  // namespace

void wakeDisturbedBodies(const btFemBodyRegistry& registry, WorldObjects& world)
{
    for (const auto& pointer : registry.records())
    {
        btFemBodyRecord& record = *pointer;
        if (!record.isStepped()) continue;
        if (isWatched(record) && isChanged(record)) record.m_softBody->activate();
    }
    world.forget();
    wakeByNeighbours(registry, world);
    for (const auto& pointer : registry.records())
    {
        btFemBodyRecord& record = *pointer;
        if (!record.isStepped()) continue;
        if (record.m_softBody->isActive())
            record.m_work.m_sleep.m_asleep = false;
        else
            markForces(record);
    }
}

void markForces(btFemBodyRecord& record)
{
    record.m_work.m_sleep.m_forces = markOfForces(*record.m_softBody);
}

void wakeIfPushed(const btFemBodyRecord& record, const btCollisionObject& other)
{
    const bool moves =
        !other.getInterpolationLinearVelocity().isZero() || !other.getInterpolationAngularVelocity().isZero();
    if (!moves || !other.isKinematicObject() || !other.isActive()) return;
    const std::lock_guard<std::mutex> lock(record.fem().m_overlaps.m_mutex);
    if (isQuiet(record)) record.m_softBody->activate();
}

void completeWokenBodies(const btFemBodyRegistry& registry)
{
    const auto collide = [](btFemBodyRecord& record, const btBroadphaseProxy& proxy)
    {
        btSoftBody* soft = record.m_softBody;
        auto* other = static_cast<btCollisionObject*>(proxy.m_clientObject);
        btDispatcher* dispatcher = soft->m_worldInfo ? soft->m_worldInfo->m_dispatcher : nullptr;
        if (dispatcher && !dispatcher->needsCollision(soft, other)) return;
        const auto& ignored = soft->m_collisionDisabledObjects;
        if (ignored.findLinearSearch(other) < ignored.size()) return;
        const btCollisionObjectWrapper wrapper(nullptr, other->getCollisionShape(), other, other->getWorldTransform(),
                                               -1, -1);
        if (btSoftBody* otherSoft = btSoftBody::upcast(other))
            soft->getSoftBodySolver()->processCollision(soft, otherSoft);
        else
            soft->getSoftBodySolver()->processCollision(soft, &wrapper);
    };
    visitNeighbours(registry, wokeWithinStep, collide);
    for (const auto& record : registry.records())
    {
        if (!record->isStepped() || !wokeWithinStep(*record)) continue;
        record->m_softBody->applyForces();
        record->m_work.m_sleep.m_asleep = false;
    }
}

void noteSpeed(btFemBodyRecord& record)
{
    record.m_work.m_sleep.m_fastestSquared = record.m_work.m_lastStep > 0 ? fastestSquared(record) : 0;
}

void updateSleep(const btFemBodyRegistry& registry, WorldObjects& world)
{
    world.forget();
    for (const auto& pointer : registry.records())
    {
        btFemBodyRecord& record = *pointer;
        if (!record.isStepped()) continue;
        updateActivation(world, record);
        const bool sleeps = record.m_softBody->getActivationState() == ISLAND_SLEEPING;
        if (sleeps && !record.m_work.m_sleep.m_asleep) fallAsleep(record);
        if (sleeps) record.m_reports.m_step.m_flags |= record.m_model.m_flags | stateFlags(record);
        // A sleeping body keeps the record of its last active step.
        const bool keeps = isWatched(record) && record.m_work.m_sleep.m_asleep;
        record.m_work.m_sleep.m_recorded = keeps;
        if (!keeps) record.m_work.m_sleep.m_neighbours.clear();
    }
    const auto lacksRecord = [](const btFemBodyRecord& record)
    { return isQuiet(record) && !record.m_work.m_sleep.m_recorded; };
    recordNeighbours(registry, world, lacksRecord);
    for (const auto& record : registry.records())
    {
        if (!record->isStepped() || !lacksRecord(*record)) continue;
        record->m_work.m_sleep.m_targets = markOfTargets(record->fem());
        record->m_work.m_sleep.m_influences = influencesOn(record->fem());
        record->m_work.m_sleep.m_recorded = true;
    }
}

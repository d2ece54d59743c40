// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "bullet_bridge/body/node_exchange.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numeric>

#include "BulletSoftBody/btSoftBody.h"
#include "bullet_bridge/body/pose_matching.h"
#include "bullet_bridge/body/soft_body_mesh.h"
#include "bullet_bridge/geometry/limits.h"
#include "bullet_fem/bullet_bridge/vectors.h"
#include "bullet_fem/fem/step/stepping.h"

namespace bullet_fem
{
namespace
{

bool sameBits(const btVector3& a, const btVector3& b)
{
    return a.x() == b.x() && a.y() == b.y() && a.z() == b.z();
}

// Copies the components of `user` that differ from `written` to `value`.
void loadChanged(const btVector3& user, const btVector3& written, Vec3& value)
{
    for (int c = 0; c < 3; ++c)
        if (user[c] != written[c]) value[c] = user[c];
}

/// Counts of changed masses of nodes that are not pinned.
struct MassChanges
{
    int m_written = 0;   // valid new masses
    int m_massless = 0;  // infinite inverse masses, see shareOutMass
};

// True for a pinned node, one with a target, and one without elements.
bool isPrescribed(const FemSoftBody& fem, std::size_t i, btScalar inverseMass)
{
    return inverseMass == 0 || fem.m_pins.m_hasTarget[i] || fem.m_body.m_model->mesh().isLoose(static_cast<int>(i));
}

void readMass(FemSoftBody& fem, int i, MassChanges& changes, NodeReadReport& report)
{
    const btScalar inverse = fem.m_softBody->m_nodes[i].m_im;
    BodyState& state = fem.m_body.m_state;
    state.m_fixed[i] = isPrescribed(fem, i, inverse);
    if (inverse == fem.m_written.m_inverseMass[i]) return;
    if (isMassless(inverse))
    {
        ++changes.m_massless;
        return;
    }
    if (inverse < 0 || !std::isfinite(inverse) || (inverse > 0 && !std::isfinite(1 / inverse)))
    {
        report.m_badMass = true;
        fem.m_softBody->m_nodes[i].m_im = fem.m_written.m_inverseMass[i];
        return;
    }
    fem.m_written.m_inverseMass[i] = inverse;
    if (!(inverse > 0)) return;
    state.m_mass[i] = 1 / double(inverse);
    ++changes.m_written;
}

// Handles btSoftBody::setTotalMass by faces, as sanitisedMasses does: if most masses were written, that call has given
// the whole mass to the surface nodes, and it is distributed by volume. If only a few nodes became massless, they keep
// their mass.
void shareOutMass(FemSoftBody& fem, const MassChanges& changes)
{
    const std::vector<double>& share = fem.m_body.m_model->shape().m_lumpedMass;
    BodyState& state = fem.m_body.m_state;
    double mass = 0, shares = 0;
    int massive = 0;
    for (int i = 0; i < fem.m_softBody->m_nodes.size(); ++i)
    {
        const btScalar inverse = fem.m_softBody->m_nodes[i].m_im;
        if (inverse == 0 || !(share[i] > 0)) continue;
        shares += share[i];
        if (isMassless(inverse)) continue;
        mass += state.m_mass[i];
        ++massive;
    }
    const bool byFaces = 2 * changes.m_written > massive;
    for (int i = 0; i < fem.m_softBody->m_nodes.size(); ++i)
    {
        btScalar& inverse = fem.m_softBody->m_nodes[i].m_im;
        if (byFaces && inverse != 0 && share[i] > 0)
        {
            state.m_mass[i] = mass * share[i] / shares;
            fem.m_written.m_inverseMass[i] = static_cast<btScalar>(1 / state.m_mass[i]);
        }
        if (inverse != 0) inverse = fem.m_written.m_inverseMass[i];
    }
}

// True if the user moved most of the free nodes: the body was teleported, and its pinned nodes jump along.
bool wasTeleported(const FemSoftBody& fem)
{
    int freeNodes = 0, moved = 0;
    for (int i = 0; i < fem.m_softBody->m_nodes.size(); ++i)
    {
        if (fem.m_body.m_state.m_fixed[i]) continue;
        ++freeNodes;
        moved += !sameBits(fem.m_softBody->m_nodes[i].m_x, fem.m_written.m_x[i]);
    }
    return 2 * moved > freeNodes;
}

// A change of velocities whose part along an edge is below this share of the largest change turns the edge as a rigid
// body does [-]; single precision leaves 1e-6.
constexpr double kRigidShare = 1e-4;

bool isVelocityWritten(const FemSoftBody& fem, int i)
{
    return !sameBits(fem.m_softBody->m_nodes[i].m_v, fem.m_written.m_v[i]);
}

// True if the changes of velocities that the user wrote stretch no edge: a rigid motion of every connected component.
bool isRigidChange(const FemSoftBody& fem)
{
    const auto change = [&](int i) { return vec3(fem.m_softBody->m_nodes[i].m_v) - vec3(fem.m_written.m_v[i]); };
    double largest = 0;
    for (int i = 0; i < fem.m_softBody->m_nodes.size(); ++i) largest = std::max(largest, norm(change(i)));
    const std::vector<Vec3>& x = fem.m_body.m_state.m_x;
    for (const Tet& nodes : fem.m_body.m_model->mesh().tets())
        for (int a = 1; a < 4; ++a)
            for (int b = 0; b < a; ++b)
            {
                const Vec3 edge = x[nodes[a]] - x[nodes[b]];
                const double along = std::fabs(dot(edge, change(nodes[a]) - change(nodes[b])));
                if (!(along <= kRigidShare * largest * norm(edge))) return false;
            }
    return true;
}

/// Writes of the user since the last writeNodes.
struct UserWrites
{
    bool m_teleported = false;  // see wasTeleported
    bool m_isState = false;     // velocities of the whole body, fixed nodes included: its new state, which strains
                                // nothing by itself; false: none, or a blow to some nodes
};

UserWrites findWrites(const FemSoftBody& fem)
{
    UserWrites writes;
    writes.m_teleported = wasTeleported(fem);
    bool any = false, all = true;
    for (int i = 0; i < fem.m_softBody->m_nodes.size(); ++i)
    {
        const bool written = isVelocityWritten(fem, i);
        any = any || written;
        all = all && (written || fem.m_body.m_model->mesh().isLoose(i));
    }
    writes.m_isState = any && (all || writes.m_teleported || isRigidChange(fem));
    return writes;
}

void readMotion(FemSoftBody& fem, int i, const UserWrites& writes, NodeReadReport& report)
{
    btSoftBody::Node& node = fem.m_softBody->m_nodes[i];
    BodyState& state = fem.m_body.m_state;
    btVector3 &writtenX = fem.m_written.m_x[i], &writtenV = fem.m_written.m_v[i];
    if (sameBits(node.m_x, writtenX) && sameBits(node.m_v, writtenV)) return;

    Vec3 x = state.m_x[i], v = state.m_v[i];
    loadChanged(node.m_x, writtenX, x);
    loadChanged(node.m_v, writtenV, v);
    if (!isBelow(kFarthest, x) || !isBelow(kFastest, v))
    {
        report.m_restored = true;
        node.m_x = writtenX;
        node.m_v = writtenV;
        return;
    }
    if (!state.m_fixed[i])
    {
        std::vector<Vec3>& prior = fem.m_body.m_loads.m_priorVelocity;
        if (!writes.m_isState && prior.empty() && !sameBits(node.m_v, writtenV)) prior = state.m_v;
        state.m_x[i] = x;
        state.m_v[i] = v;
    }
    else
    {
        const bool isPin = node.m_im == 0 || !fem.m_body.m_model->mesh().isLoose(i);
        if (isPin && !sameBits(node.m_v, writtenV)) fem.m_pins.m_velocity[i] = v;
        if (writes.m_isState) state.m_v[i] = v;
        if (writes.m_teleported)
            state.m_x[i] = x;
        else if (!sameBits(node.m_x, writtenX))
            fem.m_pins.m_position[i] = x, fem.m_pins.m_moved[i] = 1;
    }
    writtenX = node.m_x;
    writtenV = node.m_v;
}

// True if the user wrote nothing, as in most steps: the nodes are then read only once.
bool isAsWritten(const FemSoftBody& fem)
{
    const WrittenNodes& written = fem.m_written;
    const auto same = [](const btVector3& a, const btVector3& b) {
        return std::memcmp(static_cast<const btScalar*>(a), static_cast<const btScalar*>(b), 3 * sizeof(btScalar)) == 0;
    };
    for (int i = 0; i < fem.m_softBody->m_nodes.size(); ++i)
    {
        const btSoftBody::Node& node = fem.m_softBody->m_nodes[i];
        if (!same(node.m_x, written.m_x[i]) || !same(node.m_v, written.m_v[i])) return false;
        if (node.m_im != written.m_inverseMass[i]) return false;
    }
    return true;
}

// Updates fixed nodes, as targets may have been set or removed.
void readPins(FemSoftBody& fem)
{
    std::vector<unsigned char>& fixed = fem.m_body.m_state.m_fixed;
    for (std::size_t i = 0; i < fixed.size(); ++i)
    {
        const bool isFixed = isPrescribed(fem, i, fem.m_written.m_inverseMass[i]);
        if (isFixed && !fixed[i]) fem.m_pins.m_velocity[i] = {};
        fixed[i] = isFixed;
    }
}

}  // namespace

NodeReadReport readNodes(FemSoftBody& fem)
{
    NodeReadReport report;
    if (isAsWritten(fem))
    {
        readPins(fem);
        report.m_stalePins = fem.m_body.m_model->factorInput().m_fixed != fem.m_body.m_state.m_fixed;
        return report;
    }
    const UserWrites writes = findWrites(fem);
    if (writes.m_isState) fem.m_body.m_loads.m_priorVelocity.clear();
    MassChanges masses;
    for (int i = 0; i < fem.m_softBody->m_nodes.size(); ++i)
    {
        const bool wasFixed = fem.m_body.m_state.m_fixed[i];
        readMass(fem, i, masses, report);
        if (fem.m_body.m_state.m_fixed[i] && !wasFixed) fem.m_pins.m_velocity[i] = {};
        readMotion(fem, i, writes, report);
    }
    if (masses.m_massless > 0)
    {
        report.m_badMass = true;
        shareOutMass(fem, masses);
    }
    report.m_stalePins = fem.m_body.m_model->factorInput().m_fixed != fem.m_body.m_state.m_fixed;
    return report;
}

void readLedPins(FemSoftBody& fem)
{
    const btSoftBody::tNodeArray& nodes = fem.m_softBody->m_nodes;
    for (int i = 0; i < nodes.size(); ++i)
        if (nodes[i].m_im != 0 && !sameBits(nodes[i].m_x, nodes[i].m_q)) return;
    for (int i = 0; i < nodes.size(); ++i)
    {
        const btSoftBody::Node& node = nodes[i];
        if (node.m_im != 0 || sameBits(node.m_x, node.m_q) || !isBelow(kFarthest, vec3(node.m_q))) continue;
        fem.m_body.m_state.m_x[i] = vec3(node.m_q);
        fem.m_pins.m_position[i] = vec3(node.m_x);
        fem.m_pins.m_moved[i] = 1;
    }
}

double factorMismatch(const FemSoftBody& fem, double step)
{
    const BodyModel& model = *fem.m_body.m_model;
    const FactorInput& input = model.factorInput();
    const double steps = factorStep(step, fem.m_settings.m_numericalDamping, model.shape().m_material) / input.m_step;
    double least = std::min(steps, 1.0), most = std::max(steps, 1.0);
    for (std::size_t i = 0; i < input.m_mass.size(); ++i)
    {
        const double ratio = fem.m_body.m_state.m_mass[i] / input.m_mass[i];
        least = std::min(least, ratio);
        most = std::max(most, ratio);
    }
    return fem.m_body.m_model->materialMismatch() * std::max(most, 1 / least);
}

bool readLoads(FemSoftBody& fem, double step)
{
    btSoftBody& soft = *fem.m_softBody;
    const BodyState& state = fem.m_body.m_state;
    StepLoads& loads = fem.m_body.m_loads;
    const double mass = std::accumulate(state.m_mass.begin(), state.m_mass.end(), 0.0);
    bool usable = true;
    Vec3 gravity = fem.gravity();
    if (!isBelow(kFastest, step * gravity)) gravity = {}, usable = false;
    for (int i = 0; i < soft.m_nodes.size(); ++i)
    {
        Vec3 force = vec3(soft.m_nodes[i].m_f);
        if (!isBelow(kFastest * mass, step * force)) force = {}, usable = false;
        loads.m_force[i] = force + state.m_mass[i] * gravity;
        soft.m_nodes[i].m_f.setZero();

        if (!state.m_fixed[i]) continue;
        const bool goes = fem.m_pins.m_hasTarget[i] || fem.m_pins.m_moved[i];
        loads.m_targetVelocity[i] =
            goes ? (1 / step) * (fem.m_pins.m_position[i] - state.m_x[i]) : fem.m_pins.m_velocity[i];
        fem.m_pins.m_moved[i] = 0;
    }
    // Bullet multiplies velocities by 1 - kDP per step, in its deformable world by 1 - drag. The equivalent implicit
    // rate alpha is kDP / (h (1 - kDP)).
    const double kDP = fem.m_settings.m_ownGravity ? soft.m_cfg.drag : soft.m_cfg.kDP;
    loads.m_massDamping = kDP > 0 ? std::min(kDP, 0.999) / (step * (1 - std::min(kDP, 0.999))) : 0;
    matchPose(fem, step);
    return usable;
}

void writeNodes(FemSoftBody& fem)
{
    fem.m_body.m_loads.m_priorVelocity.clear();
    const BodyState& state = fem.m_body.m_state;
    for (int i = 0; i < fem.m_softBody->m_nodes.size(); ++i)
    {
        btSoftBody::Node& node = fem.m_softBody->m_nodes[i];
        node.m_q = node.m_x;
        node.m_vn = node.m_v;
        node.m_x = fem.m_written.m_x[i] = bulletVector(state.m_x[i]);
        node.m_v = fem.m_written.m_v[i] = bulletVector(state.m_v[i]);
    }
}

void setSweptBounds(FemSoftBody& fem, double step, double margin)
{
    const BodyState& state = fem.m_body.m_state;
    const Vec3 fall = step * fem.gravity();
    Vec3 lowest = {1e30, 1e30, 1e30}, highest = {-1e30, -1e30, -1e30};
    for (int i : fem.m_body.m_model->mesh().surfaceNodes())
    {
        const Vec3 now = state.m_x[i], then = now + step * (state.m_v[i] + fall);
        for (int c = 0; c < 3; ++c)
        {
            lowest[c] = std::min({lowest[c], now[c], then[c]});
            highest[c] = std::max({highest[c], now[c], then[c]});
        }
    }
    const double wide = margin + fem.m_settings.m_contactOffset;
    fem.m_softBody->m_bounds[0] = bulletVector(lowest - Vec3{wide, wide, wide});
    fem.m_softBody->m_bounds[1] = bulletVector(highest + Vec3{wide, wide, wide});
}

}  // namespace bullet_fem

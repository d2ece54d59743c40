// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// Compiled once for every instruction set; the processor chooses when the program runs.
#include "fem/lanes/lane_momentum.h"

#include "fem/vector_targets.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "fem/lanes/lane_momentum.cpp"
#include <hwy/foreach_target.h>
// after foreach_target.h
#include "fem/lanes/lane_vectors-inl.h"

HWY_BEFORE_NAMESPACE();
namespace bullet_fem
{
namespace HWY_NAMESPACE
{

HWY_INLINE V3 load(const PerLane3& from, int lane)
{
    return {loadOne(from[0].m + lane), loadOne(from[1].m + lane), loadOne(from[2].m + lane)};
}

HWY_INLINE void store(const V3& v, int lane, PerLane3& to)
{
    hn::Store(v.x, D(), to[0].m + lane);
    hn::Store(v.y, D(), to[1].m + lane);
    hn::Store(v.z, D(), to[2].m + lane);
}

HWY_INLINE V massAt(const LaneMasses& nodes, int node, int lane)
{
    return loadOne(nodes.m_mass + massPlace(node, lane));
}

HWY_INLINE V3 positionAt(const LaneMasses& nodes, int node, int lane)
{
    return load3(nodes.m_x + place(node, lane));
}

void SumMasses(const LaneMasses& nodes, LanePieces& pieces)
{
    for (int lane = 0; lane < kBodyLanes; lane += kN)
    {
        const V zero = hn::Zero(D());
        V mass = zero;
        V3 center = {zero, zero, zero};
        for (int i = 0; i < nodes.m_nodes; ++i)
        {
            const V m = massAt(nodes, i, lane);
            mass = mass + m;
            center = center + positionAt(nodes, i, lane) * m;
        }
        hn::Store(mass, D(), pieces.m_mass.m + lane);
        store(center, lane, pieces.m_center);
    }
}

void SumPrescribed(const LaneMasses& nodes, const LaneLoads& loads, LanePieces& pieces)
{
    for (int lane = 0; lane < kBodyLanes; lane += kN)
    {
        const V zero = hn::Zero(D()), alpha = loadOne(loads.m_alpha.m + lane), share = loadOne(loads.m_share.m + lane);
        const V3 center = load(pieces.m_center, lane);
        V3 linear = {zero, zero, zero}, angular = linear, diagonal = linear, others = linear;  // yz, xz, xy
        for (int i = 0; i < nodes.m_nodes; ++i)
        {
            const V m = massAt(nodes, i, lane);
            const V3 r = positionAt(nodes, i, lane) - center, p = load3(loads.m_v + place(i, lane)) * m;
            const V3 force = load3(loads.m_force + place(i, lane)) - p * alpha;
            const V3 prescribed = p + force * share;
            linear = linear + prescribed;
            angular = angular + cross(r, prescribed);
            const V rr = dot(r, r);
            diagonal = diagonal + V3{rr - r.x * r.x, rr - r.y * r.y, rr - r.z * r.z} * m;
            others = others + V3{zero - r.y * r.z, zero - r.x * r.z, zero - r.x * r.y} * m;
        }
        store(linear, lane, pieces.m_linear);
        store(angular, lane, pieces.m_angular);
        const V inertia[9] = {diagonal.x, others.z, others.y, others.z,  diagonal.y,
                              others.x,   others.y, others.x, diagonal.z};
        for (int k = 0; k < 9; ++k) hn::Store(inertia[k], D(), pieces.m_inertia[k].m + lane);
    }
}

void AddImpulses(const LaneMasses& nodes, ConstBodyVectors impulses, const PerLane& share, LanePieces& pieces)
{
    for (int lane = 0; lane < kBodyLanes; lane += kN)
    {
        const V3 center = load(pieces.m_center, lane);
        V3 linear = load(pieces.m_linear, lane), angular = load(pieces.m_angular, lane);
        for (int i = 0; i < nodes.m_nodes; ++i)
        {
            const V3 impulse = load3(impulses + place(i, lane)) * loadOne(share.m + lane);
            linear = linear + impulse;
            angular = angular + cross(positionAt(nodes, i, lane) - center, impulse);
        }
        store(linear, lane, pieces.m_linear);
        store(angular, lane, pieces.m_angular);
    }
}

/// Adds to before(i, lane) the rigid motion that gives a body its momentum, and hands it to then(i, lane, velocity).
template <class Before, class Then>
HWY_INLINE void restore(const LaneMasses& nodes, const LanePieces& pieces, const Before& before, const Then& then)
{
    for (int lane = 0; lane < kBodyLanes; lane += kN)
    {
        const V3 center = load(pieces.m_center, lane);
        V3 linear = load(pieces.m_linear, lane), angular = load(pieces.m_angular, lane);
        for (int i = 0; i < nodes.m_nodes; ++i)
        {
            const V3 p = before(i, lane) * massAt(nodes, i, lane);
            linear = linear - p;
            angular = angular - cross(positionAt(nodes, i, lane) - center, p);
        }
        linear = linear * (hn::Set(D(), 1.0) / loadOne(pieces.m_mass.m + lane));
        const auto row = [&](int k)
        {
            const PerLane* I = pieces.m_inertia + 3 * k;
            return dot({loadOne(I[0].m + lane), loadOne(I[1].m + lane), loadOne(I[2].m + lane)}, angular);
        };
        const V3 spin = {row(0), row(1), row(2)};
        for (int i = 0; i < nodes.m_nodes; ++i)
        {
            const V3 rigid = linear + cross(spin, positionAt(nodes, i, lane) - center);
            then(i, lane, before(i, lane) + rigid);
        }
    }
}

void CompleteIncrements(const LaneMasses& nodes, const LanePieces& pieces, ConstBodyVectors v, BodyVectors dv)
{
    const auto before = [=](int i, int lane) { return load3(dv + place(i, lane)) + load3(v + place(i, lane)); };
    const auto then = [=](int i, int lane, const V3& after)
    { store3(after - load3(v + place(i, lane)), dv + place(i, lane)); };
    restore(nodes, pieces, before, then);
}

void RestoreMomentum(const LaneMasses& nodes, const LanePieces& pieces, BodyVectors velocity)
{
    const auto before = [=](int i, int lane) { return load3(velocity + place(i, lane)); };
    const auto then = [=](int i, int lane, const V3& after) { store3(after, velocity + place(i, lane)); };
    restore(nodes, pieces, before, then);
}

}  // namespace HWY_NAMESPACE
}  // namespace bullet_fem
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace bullet_fem
{

HWY_EXPORT(SumMasses);
HWY_EXPORT(SumPrescribed);
HWY_EXPORT(AddImpulses);
HWY_EXPORT(CompleteIncrements);
HWY_EXPORT(RestoreMomentum);

void sumMasses(const LaneMasses& nodes, LanePieces& pieces)
{
    HWY_DYNAMIC_DISPATCH(SumMasses)(nodes, pieces);
}

void sumPrescribed(const LaneMasses& nodes, const LaneLoads& loads, LanePieces& pieces)
{
    HWY_DYNAMIC_DISPATCH(SumPrescribed)(nodes, loads, pieces);
}

void addImpulses(const LaneMasses& nodes, ConstBodyVectors impulses, const PerLane& share, LanePieces& pieces)
{
    HWY_DYNAMIC_DISPATCH(AddImpulses)(nodes, impulses, share, pieces);
}

void completeIncrements(const LaneMasses& nodes, const LanePieces& pieces, ConstBodyVectors v, BodyVectors dv)
{
    HWY_DYNAMIC_DISPATCH(CompleteIncrements)(nodes, pieces, v, dv);
}

void restoreMomentum(const LaneMasses& nodes, const LanePieces& pieces, BodyVectors velocity)
{
    HWY_DYNAMIC_DISPATCH(RestoreMomentum)(nodes, pieces, velocity);
}

}  // namespace bullet_fem
#endif

// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// Compiled once for every instruction set; selected at run time.
#include "fem/batch/batch_algebra.h"

#include "fem/common/vector_targets.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "fem/batch/batch_momentum.cpp"
#include <hwy/foreach_target.h>
// after foreach_target.h
#include "fem/batch/batch_vectors-inl.h"

HWY_BEFORE_NAMESPACE();
namespace bullet_fem
{
namespace HWY_NAMESPACE
{

HWY_INLINE V3 load(const PerBatch3& from, int lane)
{
    return {valuesOf(from[0], lane), valuesOf(from[1], lane), valuesOf(from[2], lane)};
}

HWY_INLINE void store(const V3& v, int lane, PerBatch3& to)
{
    storeValues(v.x, lane, to[0]);
    storeValues(v.y, lane, to[1]);
    storeValues(v.z, lane, to[2]);
}

HWY_INLINE V massAt(const BatchMasses& nodes, int node, int lane)
{
    return loadOne(nodes.m_mass + massPlace(node, lane));
}

HWY_INLINE V3 positionAt(const BatchMasses& nodes, int node, int lane)
{
    return load3(nodes.m_x + place(node, lane));
}

void SumMasses(const BatchMasses& nodes, BatchMomenta& pieces)
{
    for (int lane = 0; lane < kBatchWidth; lane += kN)
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
        storeValues(mass, lane, pieces.m_mass);
        store(center, lane, pieces.m_center);
    }
}

PerBatch SumPrescribed(const BatchMasses& nodes, const BatchLoads& loads, BatchMomenta& pieces)
{
    PerBatch squares;
    for (int lane = 0; lane < kBatchWidth; lane += kN)
    {
        const V zero = hn::Zero(D()), alpha = valuesOf(loads.m_alpha, lane), share = valuesOf(loads.m_share, lane);
        const V3 center = load(pieces.m_center, lane);
        V3 linear = {zero, zero, zero}, angular = linear, diagonal = linear, others = linear;  // yz, xz, xy
        V square = zero;
        for (int i = 0; i < nodes.m_nodes; ++i)
        {
            const V m = massAt(nodes, i, lane);
            const V3 r = positionAt(nodes, i, lane) - center, p = load3(loads.m_v + place(i, lane)) * m;
            const V3 load = load3(loads.m_force + place(i, lane)), prescribed = p + (load - p * alpha) * share;
            square = square + dot(load, load);
            linear = linear + prescribed;
            angular = angular + cross(r, prescribed);
            const V rr = dot(r, r);
            diagonal = diagonal + V3{rr - r.x * r.x, rr - r.y * r.y, rr - r.z * r.z} * m;
            others = others + V3{zero - r.y * r.z, zero - r.x * r.z, zero - r.x * r.y} * m;
        }
        storeValues(square, lane, squares);
        store(linear, lane, pieces.m_linear);
        store(angular, lane, pieces.m_angular);
        const V inertia[9] = {diagonal.x, others.z, others.y, others.z,  diagonal.y,
                              others.x,   others.y, others.x, diagonal.z};
        for (int k = 0; k < 9; ++k) storeValues(inertia[k], lane, pieces.m_inertia[k]);
    }
    return squares;
}

PerBatch AddImpulses(const BatchMasses& nodes, ConstBodyVectors impulses, const PerBatch& share, BatchMomenta& pieces)
{
    PerBatch squares;
    for (int lane = 0; lane < kBatchWidth; lane += kN)
    {
        const V3 center = load(pieces.m_center, lane);
        V3 linear = load(pieces.m_linear, lane), angular = load(pieces.m_angular, lane);
        V square = hn::Zero(D());
        for (int i = 0; i < nodes.m_nodes; ++i)
        {
            const V3 given = load3(impulses + place(i, lane)), impulse = given * valuesOf(share, lane);
            square = square + dot(given, given);
            linear = linear + impulse;
            angular = angular + cross(positionAt(nodes, i, lane) - center, impulse);
        }
        storeValues(square, lane, squares);
        store(linear, lane, pieces.m_linear);
        store(angular, lane, pieces.m_angular);
    }
    return squares;
}

/// Product of the inverse inertia and a vector.
HWY_INLINE V3 timesInertia(const BatchMomenta& pieces, int lane, const V3& vector)
{
    const auto row = [&](int k)
    {
        const PerBatch* I = pieces.m_inertia + 3 * k;
        return dot({valuesOf(I[0], lane), valuesOf(I[1], lane), valuesOf(I[2], lane)}, vector);
    };
    return {row(0), row(1), row(2)};
}

/// Adds to before(i, lane) the rigid motion that restores a body's momentum, and calls then(i, lane, velocity) with it.
template <class Before, class Then>
HWY_INLINE void restore(const BatchMasses& nodes, const BatchMomenta& pieces, const Before& before, const Then& then)
{
    for (int lane = 0; lane < kBatchWidth; lane += kN)
    {
        const V3 center = load(pieces.m_center, lane);
        V3 linear = load(pieces.m_linear, lane), angular = load(pieces.m_angular, lane);
        for (int i = 0; i < nodes.m_nodes; ++i)
        {
            const V3 p = before(i, lane) * massAt(nodes, i, lane);
            linear = linear - p;
            angular = angular - cross(positionAt(nodes, i, lane) - center, p);
        }
        linear = linear * (hn::Set(D(), 1.0) / valuesOf(pieces.m_mass, lane));
        const V3 spin = timesInertia(pieces, lane, angular);
        for (int i = 0; i < nodes.m_nodes; ++i)
        {
            const V3 rigid = linear + cross(spin, positionAt(nodes, i, lane) - center);
            then(i, lane, before(i, lane) + rigid);
        }
    }
}

void FindViscous(const BatchMasses& nodes, const BatchMomenta& pieces, const BatchTurning& turning, BodyVectors w)
{
    for (int lane = 0; lane < kBatchWidth; lane += kN)
    {
        const V step = hn::Set(D(), turning.m_step), ofVelocity = hn::Set(D(), turning.m_ofVelocity),
                ofTurning = hn::Set(D(), turning.m_ofTurning);
        const V3 center = load(pieces.m_center, lane), spin = timesInertia(pieces, lane, load(pieces.m_angular, lane));
        for (int i = 0; i < nodes.m_nodes; ++i)
        {
            const V3 r = positionAt(nodes, i, lane) - center, turned = cross(spin, cross(spin, r)) * step;
            store3(load3(turning.m_v + place(i, lane)) * ofVelocity - turned * ofTurning, w + place(i, lane));
        }
    }
}

void CompleteIncrements(const BatchMasses& nodes, const BatchMomenta& pieces, ConstBodyVectors v, BodyVectors dv)
{
    const auto before = [=](int i, int lane) { return load3(dv + place(i, lane)) + load3(v + place(i, lane)); };
    const auto then = [=](int i, int lane, const V3& after)
    { store3(after - load3(v + place(i, lane)), dv + place(i, lane)); };
    restore(nodes, pieces, before, then);
}

void AddWithMomentum(const BatchMasses& nodes, const BatchMomenta& pieces, ConstBodyVectors dv, BodyVectors v)
{
    const auto before = [=](int i, int lane) { return load3(v + place(i, lane)) + load3(dv + place(i, lane)); };
    const auto then = [=](int i, int lane, const V3& after) { store3(after, v + place(i, lane)); };
    restore(nodes, pieces, before, then);
}

}  // namespace HWY_NAMESPACE
}  // namespace bullet_fem
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace bullet_fem
{

BULLETFEM_EXPORT(SumMasses, void sumMasses(const BatchMasses& nodes, BatchMomenta& pieces), nodes, pieces)
BULLETFEM_EXPORT(SumPrescribed,
                 PerBatch sumPrescribed(const BatchMasses& nodes, const BatchLoads& loads, BatchMomenta& pieces), nodes,
                 loads, pieces)
BULLETFEM_EXPORT(AddImpulses,
                 PerBatch addImpulses(const BatchMasses& nodes, ConstBodyVectors impulses, const PerBatch& share,
                                      BatchMomenta& pieces),
                 nodes, impulses, share, pieces)
BULLETFEM_EXPORT(FindViscous,
                 void findViscous(const BatchMasses& nodes, const BatchMomenta& pieces, const BatchTurning& turning,
                                  BodyVectors w),
                 nodes, pieces, turning, w)
BULLETFEM_EXPORT(CompleteIncrements,
                 void completeIncrements(const BatchMasses& nodes, const BatchMomenta& pieces, ConstBodyVectors v,
                                         BodyVectors dv),
                 nodes, pieces, v, dv)
BULLETFEM_EXPORT(AddWithMomentum,
                 void addWithMomentum(const BatchMasses& nodes, const BatchMomenta& pieces, ConstBodyVectors dv,
                                      BodyVectors v),
                 nodes, pieces, dv, v)

}  // namespace bullet_fem
#endif

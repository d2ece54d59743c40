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

/// A rigid motion of bodies: velocity of the centres, and angular velocity.
struct Rigid
{
    V3 m_center, m_linear, m_angular;

    HWY_INLINE V3 at(const V3& x) const { return m_linear + cross(m_angular, x - m_center); }
};

/// The rigid motion with these momenta about the bodies' centres.
HWY_INLINE Rigid motionOf(const BatchMomenta& pieces, int lane, const V3& linear, const V3& angular)
{
    return {load(pieces.m_center, lane), linear * (hn::Set(D(), 1.0) / valuesOf(pieces.m_mass, lane)),
            timesInertia(pieces, lane, angular)};
}

/// The rigid motion that brings velocity(i) to these momenta.
template <class Velocity>
HWY_INLINE Rigid missingMotion(const BatchMasses& nodes, const BatchMomenta& pieces, int lane, V3 linear, V3 angular,
                               const Velocity& velocity)
{
    const V3 center = load(pieces.m_center, lane);
    for (int i = 0; i < nodes.m_nodes; ++i)
    {
        const V3 p = velocity(i) * massAt(nodes, i, lane);
        linear = linear - p;
        angular = angular - cross(positionAt(nodes, i, lane) - center, p);
    }
    return motionOf(pieces, lane, linear, angular);
}

HWY_INLINE V3 zero3()
{
    const V zero = hn::Zero(D());
    return {zero, zero, zero};
}

/// Sums with . change(i, lane, motion) over the nodes, where change() stores its result.
template <class Change>
HWY_INLINE PerBatch sumChanged(int nodes, const Rigid (&motions)[kBatchWidth / kN], ConstBodyVectors with,
                               const Change& change)
{
    return sumOverNodes(nodes,
                        [&](int i, int lane)
                        {
                            const V3 changed = change(i, lane, motions[lane / kN]);
                            return dot(load3(with + place(i, lane)), changed);
                        });
}

void AddInward(const BatchMasses& nodes, const BatchMomenta& pieces, double factor, BodyVectors change)
{
    const V f = hn::Set(D(), factor);
    for (int lane = 0; lane < kBatchWidth; lane += kN)
    {
        const V3 center = load(pieces.m_center, lane), spin = timesInertia(pieces, lane, load(pieces.m_angular, lane));
        for (int i = 0; i < nodes.m_nodes; ++i)
        {
            const V3 inward = cross(spin, cross(spin, positionAt(nodes, i, lane) - center));
            store3(load3(change + place(i, lane)) + inward * f, change + place(i, lane));
        }
    }
}

void AddCentrifugal(const BatchMasses& nodes, const BatchMomenta& pieces, double step, BodyVectors b)
{
    const V h = hn::Set(D(), step);
    for (int lane = 0; lane < kBatchWidth; lane += kN)
    {
        const V3 center = load(pieces.m_center, lane), spin = timesInertia(pieces, lane, load(pieces.m_angular, lane));
        for (int i = 0; i < nodes.m_nodes; ++i)
        {
            const V3 inward = cross(spin, cross(spin, positionAt(nodes, i, lane) - center));
            store3(load3(b + place(i, lane)) - inward * (h * massAt(nodes, i, lane)), b + place(i, lane));
        }
    }
}

PerBatch RemoveImpulses(const BatchMasses& nodes, const BatchMomenta& pieces, ConstBodyVectors with, BodyVectors J)
{
    Rigid motions[kBatchWidth / kN];
    for (int lane = 0; lane < kBatchWidth; lane += kN)
    {
        const V3 center = load(pieces.m_center, lane);
        V3 linear = zero3(), angular = linear;
        for (int i = 0; i < nodes.m_nodes; ++i)
        {
            const V3 impulse = load3(J + place(i, lane));
            linear = linear + impulse;
            angular = angular + cross(positionAt(nodes, i, lane) - center, impulse);
        }
        motions[lane / kN] = motionOf(pieces, lane, linear, angular);
    }
    return sumChanged(nodes.m_nodes, motions, with,
                      [&](int i, int lane, const Rigid& motion)
                      {
                          const V3 rigid = motion.at(positionAt(nodes, i, lane)) * massAt(nodes, i, lane);
                          const V3 left = load3(J + place(i, lane)) - rigid;
                          store3(left, J + place(i, lane));
                          return left;
                      });
}

PerBatch RemoveMotion(const BatchMasses& nodes, const BatchMomenta& pieces, ConstBodyVectors with, BodyVectors dv)
{
    Rigid motions[kBatchWidth / kN];
    for (int lane = 0; lane < kBatchWidth; lane += kN)
        motions[lane / kN] =
            missingMotion(nodes, pieces, lane, zero3(), zero3(), [&](int i) { return load3(dv + place(i, lane)); });
    return sumChanged(nodes.m_nodes, motions, with,
                      [&](int i, int lane, const Rigid& without)
                      {
                          const V3 left = load3(dv + place(i, lane)) + without.at(positionAt(nodes, i, lane));
                          store3(left, dv + place(i, lane));
                          return left;
                      });
}

void AddWithMomentum(const BatchMasses& nodes, const BatchMomenta& pieces, ConstBodyVectors dv, BodyVectors v)
{
    for (int lane = 0; lane < kBatchWidth; lane += kN)
    {
        const auto velocity = [&](int i) { return load3(v + place(i, lane)) + load3(dv + place(i, lane)); };
        const Rigid missing =
            missingMotion(nodes, pieces, lane, load(pieces.m_linear, lane), load(pieces.m_angular, lane), velocity);
        for (int i = 0; i < nodes.m_nodes; ++i)
            store3(velocity(i) + missing.at(positionAt(nodes, i, lane)), v + place(i, lane));
    }
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
BULLETFEM_EXPORT(AddInward,
                 void addInward(const BatchMasses& nodes, const BatchMomenta& pieces, double factor,
                                BodyVectors change),
                 nodes, pieces, factor, change)
BULLETFEM_EXPORT(AddCentrifugal,
                 void addCentrifugal(const BatchMasses& nodes, const BatchMomenta& pieces, double step, BodyVectors b),
                 nodes, pieces, step, b)
BULLETFEM_EXPORT(RemoveImpulses,
                 PerBatch removeImpulses(const BatchMasses& nodes, const BatchMomenta& pieces, ConstBodyVectors with,
                                         BodyVectors J),
                 nodes, pieces, with, J)
BULLETFEM_EXPORT(RemoveMotion,
                 PerBatch removeMotion(const BatchMasses& nodes, const BatchMomenta& pieces, ConstBodyVectors with,
                                       BodyVectors dv),
                 nodes, pieces, with, dv)
BULLETFEM_EXPORT(AddWithMomentum,
                 void addWithMomentum(const BatchMasses& nodes, const BatchMomenta& pieces, ConstBodyVectors dv,
                                      BodyVectors v),
                 nodes, pieces, dv, v)

}  // namespace bullet_fem
#endif

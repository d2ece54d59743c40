// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// Compiled once for every instruction set; selected at run time.
#include "fem/batch/batch_algebra.h"

#include <cstddef>

#include "fem/common/vector_targets.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "fem/batch/batch_algebra.cpp"
#include <hwy/foreach_target.h>
// after foreach_target.h
#include "fem/batch/batch_vectors-inl.h"

HWY_BEFORE_NAMESPACE();
namespace bullet_fem
{
namespace HWY_NAMESPACE
{

void SubtractLanes(ConstBodyVectors a, ConstBodyVectors b, BodyVectors out, int nodes)
{
    forEachNumber(nodes, [&](std::size_t at, int) { hn::Store(loadOne(a + at) - loadOne(b + at), D(), out + at); });
}

void ContinueLanes(ConstBodyVectors a, ConstBodyVectors b, BodyVectors out, int nodes)
{
    const V two = hn::Set(D(), 2.0);
    forEachNumber(nodes,
                  [&](std::size_t at, int) { hn::Store(loadOne(a + at) * two - loadOne(b + at), D(), out + at); });
}

void AddLanes(ConstBodyVectors b, BodyVectors a, int nodes)
{
    forEachNumber(nodes, [&](std::size_t at, int) { hn::Store(loadOne(a + at) + loadOne(b + at), D(), a + at); });
}

void ScaleVectors(double factor, ConstBodyVectors a, BodyVectors out, int nodes)
{
    const V s = hn::Set(D(), factor);
    forEachNumber(nodes, [&](std::size_t at, int) { hn::Store(loadOne(a + at) * s, D(), out + at); });
}

HWY_INLINE V3 choose(hn::Mask<D> yes, const V3& a, const V3& b)
{
    return {hn::IfThenElse(yes, a.x, b.x), hn::IfThenElse(yes, a.y, b.y), hn::IfThenElse(yes, a.z, b.z)};
}

/// Stores the value in active bodies.
HWY_INLINE void storeActive(const BatchRecurrence& v, const V3& value, int lane, double* to)
{
    const auto active = valuesOf(v.m_active, lane) > hn::Zero(D());
    store3(choose(active, value, load3(to)), to);
}

/// Stores r in active bodies; returns |r|^2.
HWY_INLINE V storeResidual(const BatchRecurrence& v, const V3& r, int lane, std::size_t at)
{
    storeActive(v, r, lane, v.m_r + at);
    return dot(r, r);
}

PerBatch SubtractProduct(const BatchRecurrence& v)
{
    return sumOverNodes(v.m_nodes,
                        [&](int node, int lane)
                        {
                            const std::size_t at = place(node, lane);
                            return storeResidual(v, load3(v.m_b + at) - load3(v.m_Ap + at), lane, at);
                        });
}

void ClearOthers(const PerBatch& kept, BodyVectors a, int nodes)
{
    forEachNumber(nodes,
                  [&](std::size_t at, int lane)
                  {
                      const auto keeps = valuesOf(kept, lane) > hn::Zero(D());
                      hn::Store(hn::IfThenElseZero(keeps, loadOne(a + at)), D(), a + at);
                  });
}

PerBatch ScaleGuess(const BatchRecurrence& v, const PerBatch& scale)
{
    return sumOverNodes(v.m_nodes,
                        [&](int node, int lane)
                        {
                            const std::size_t at = place(node, lane);
                            const V s = valuesOf(scale, lane);
                            const V3 b = load3(v.m_b + at);
                            storeActive(v, load3(v.m_x + at) * s, lane, v.m_x + at);
                            return storeResidual(v, choose(s > hn::Zero(D()), b - load3(v.m_Ap + at) * s, b), lane, at);
                        });
}

void TurnDirection(const BatchRecurrence& v, ConstBodyVectors z, const PerBatch& beta)
{
    forEachNode(v.m_nodes,
                [&](int node, int lane)
                {
                    const std::size_t at = place(node, lane);
                    const V b = valuesOf(beta, lane);
                    const V3 zi = load3(z + at), turned = zi + load3(v.m_p + at) * b;
                    storeActive(v, choose(b > hn::Zero(D()), turned, zi), lane, v.m_p + at);
                });
}

PerBatch AdvanceAlong(const BatchRecurrence& v, const PerBatch& step)
{
    return sumOverNodes(v.m_nodes,
                        [&](int node, int lane)
                        {
                            const std::size_t at = place(node, lane);
                            const V s = valuesOf(step, lane);
                            storeActive(v, load3(v.m_x + at) + load3(v.m_p + at) * s, lane, v.m_x + at);
                            return storeResidual(v, load3(v.m_r + at) + load3(v.m_Ap + at) * hn::Neg(s), lane, at);
                        });
}

void AddForces(const BatchInertia& inertia, const PerBatch& alpha, double step, ConstBodyVectors v, BodyVectors b)
{
    const V h = hn::Set(D(), step);
    forEachNode(inertia.m_nodes,
                [&](int node, int lane)
                {
                    const V alphaMass = valuesOf(alpha, lane) * loadOne(inertia.m_mass + massPlace(node, lane));
                    const std::size_t at = place(node, lane);
                    const V3 damped = load3(b + at) - load3(v + at) * alphaMass;
                    store3((damped + takeSum(inertia.m_sums, node, lane)) * h, b + at);
                });
}

void SubtractSums(const BatchInertia& inertia, double share, BodyVectors b)
{
    const V s = hn::Set(D(), share);
    forEachNode(inertia.m_nodes,
                [&](int node, int lane)
                {
                    const std::size_t at = place(node, lane);
                    store3(load3(b + at) - takeSum(inertia.m_sums, node, lane) * s, b + at);
                });
}

void AddInertia(const BatchInertia& inertia, const PerBatch& factor, ConstBodyVectors p, BodyVectors Ap)
{
    forEachNode(inertia.m_nodes,
                [&](int node, int lane)
                {
                    const V3 pi = load3(p + place(node, lane));
                    const V scaledMass = valuesOf(factor, lane) * loadOne(inertia.m_mass + massPlace(node, lane));
                    const V3 sum = takeSum(inertia.m_sums, node, lane);
                    store3({hn::MulAdd(scaledMass, pi.x, sum.x), hn::MulAdd(scaledMass, pi.y, sum.y),
                            hn::MulAdd(scaledMass, pi.z, sum.z)},
                           Ap + place(node, lane));
                });
}

BatchGuessMeasure MeasureGuess(const BatchGuess& guess)
{
    BatchGuessMeasure out;
    sumsOverNodes<4>(guess.m_nodes, {&out.m_xx, &out.m_bx, &out.m_xAx, &out.m_residual},
                     [&](int node, int lane)
                     {
                         const std::size_t at = place(node, lane);
                         const V3 x = load3(guess.m_x + at), b = load3(guess.m_b + at);
                         const V3 Ax = load3(guess.m_Ax + at), r = b - Ax;
                         return Terms<4>{{dot(x, x), dot(b, x), dot(x, Ax), dot(r, r)}};
                     });
    return out;
}

}  // namespace HWY_NAMESPACE
}  // namespace bullet_fem
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace bullet_fem
{

BULLETFEM_EXPORT(SubtractLanes, void subtract(ConstBodyVectors a, ConstBodyVectors b, BodyVectors out, int nodes), a, b,
                 out, nodes)
BULLETFEM_EXPORT(ContinueLanes, void extrapolate(ConstBodyVectors a, ConstBodyVectors b, BodyVectors out, int nodes), a,
                 b, out, nodes)
BULLETFEM_EXPORT(AddLanes, void addVectors(ConstBodyVectors b, BodyVectors a, int nodes), b, a, nodes)
BULLETFEM_EXPORT(ScaleVectors, void scaleVectors(double factor, ConstBodyVectors a, BodyVectors out, int nodes), factor,
                 a, out, nodes)
BULLETFEM_EXPORT(SubtractProduct, PerBatch subtractProduct(const BatchRecurrence& v), v)
BULLETFEM_EXPORT(ClearOthers, void clearOthers(const PerBatch& kept, BodyVectors a, int nodes), kept, a, nodes)
BULLETFEM_EXPORT(ScaleGuess, PerBatch scaleGuess(const BatchRecurrence& v, const PerBatch& scale), v, scale)
BULLETFEM_EXPORT(TurnDirection, void turnDirection(const BatchRecurrence& v, ConstBodyVectors z, const PerBatch& beta),
                 v, z, beta)
BULLETFEM_EXPORT(AdvanceAlong, PerBatch advanceAlong(const BatchRecurrence& v, const PerBatch& step), v, step)
BULLETFEM_EXPORT(AddForces,
                 void addForces(const BatchInertia& inertia, const PerBatch& alpha, double step, ConstBodyVectors v,
                                BodyVectors b),
                 inertia, alpha, step, v, b)
BULLETFEM_EXPORT(SubtractSums, void subtractSums(const BatchInertia& inertia, double share, BodyVectors b), inertia,
                 share, b)
BULLETFEM_EXPORT(AddInertia,
                 void addInertia(const BatchInertia& inertia, const PerBatch& factor, ConstBodyVectors p,
                                 BodyVectors Ap),
                 inertia, factor, p, Ap)
BULLETFEM_EXPORT(MeasureGuess, BatchGuessMeasure measureGuess(const BatchGuess& guess), guess)

}  // namespace bullet_fem
#endif

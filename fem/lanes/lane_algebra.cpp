// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// Compiled once for every instruction set; the processor chooses when the program runs.
#include "fem/lanes/lane_algebra.h"

#include <cstddef>

#include "fem/vector_targets.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "fem/lanes/lane_algebra.cpp"
#include <hwy/foreach_target.h>
// after foreach_target.h
#include "fem/lanes/lane_vectors-inl.h"

HWY_BEFORE_NAMESPACE();
namespace bullet_fem
{
namespace HWY_NAMESPACE
{

HWY_INLINE V dotAt(ConstBodyVectors a, ConstBodyVectors b, std::size_t at)
{
    return dot(load3(a + at), load3(b + at));
}

void DotLanes(ConstBodyVectors a, ConstBodyVectors b, int nodes, PerLane& out)
{
    sumOverNodes(nodes, out, [=](int node, int lane) { return dotAt(a, b, place(node, lane)); });
}

void SquareInOrder(ConstBodyVectors a, int nodes, PerLane& out)
{
    for (int lane = 0; lane < kBodyLanes; lane += kN)
    {
        V sum = hn::Zero(D());
        for (int i = 0; i < nodes; ++i) sum = sum + dotAt(a, a, place(i, lane));
        hn::Store(sum, D(), out.m + lane);
    }
}

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

HWY_INLINE V3 choose(hn::Mask<D> yes, const V3& a, const V3& b)
{
    return {hn::IfThenElse(yes, a.x, b.x), hn::IfThenElse(yes, a.y, b.y), hn::IfThenElse(yes, a.z, b.z)};
}

/// Writes where the body is active.
HWY_INLINE void storeActive(const LaneRecurrence& v, const V3& value, int lane, double* to)
{
    const auto active = loadOne(v.m_active.m + lane) > hn::Zero(D());
    store3(choose(active, value, load3(to)), to);
}

/// Writes r where the body is active; returns |r|^2.
HWY_INLINE V storeResidual(const LaneRecurrence& v, const V3& r, int lane, std::size_t at)
{
    storeActive(v, r, lane, v.m_r + at);
    return dot(r, r);
}

void SubtractProduct(const LaneRecurrence& v, PerLane& squares)
{
    sumOverNodes(v.m_nodes, squares,
                 [&](int node, int lane)
                 {
                     const std::size_t at = place(node, lane);
                     return storeResidual(v, load3(v.m_b + at) - load3(v.m_Ap + at), lane, at);
                 });
}

void ClearOthers(const PerLane& kept, BodyVectors a, int nodes)
{
    forEachNumber(nodes,
                  [&](std::size_t at, int lane)
                  {
                      const auto keeps = loadOne(kept.m + lane) > hn::Zero(D());
                      hn::Store(hn::IfThenElseZero(keeps, loadOne(a + at)), D(), a + at);
                  });
}

void ScaleGuess(const LaneRecurrence& v, const PerLane& scale, PerLane& squares)
{
    sumOverNodes(v.m_nodes, squares,
                 [&](int node, int lane)
                 {
                     const std::size_t at = place(node, lane);
                     const V s = loadOne(scale.m + lane);
                     const V3 b = load3(v.m_b + at);
                     storeActive(v, load3(v.m_x + at) * s, lane, v.m_x + at);
                     return storeResidual(v, choose(s > hn::Zero(D()), b - load3(v.m_Ap + at) * s, b), lane, at);
                 });
}

void TurnDirection(const LaneRecurrence& v, ConstBodyVectors z, const PerLane& beta)
{
    forEachNode(v.m_nodes,
                [&](int node, int lane)
                {
                    const std::size_t at = place(node, lane);
                    const V b = loadOne(beta.m + lane);
                    const V3 zi = load3(z + at), turned = zi + load3(v.m_p + at) * b;
                    storeActive(v, choose(b > hn::Zero(D()), turned, zi), lane, v.m_p + at);
                });
}

void AdvanceAlong(const LaneRecurrence& v, const PerLane& step, PerLane& squares)
{
    sumOverNodes(v.m_nodes, squares,
                 [&](int node, int lane)
                 {
                     const std::size_t at = place(node, lane);
                     const V s = loadOne(step.m + lane);
                     storeActive(v, load3(v.m_x + at) + load3(v.m_p + at) * s, lane, v.m_x + at);
                     return storeResidual(v, load3(v.m_r + at) + load3(v.m_Ap + at) * hn::Neg(s), lane, at);
                 });
}

void SubtractDamping(const double* mass, ConstBodyVectors v, const PerLane& alpha, BodyVectors f, int nodes)
{
    forEachNode(nodes,
                [&](int node, int lane)
                {
                    const V alphaMass = loadOne(alpha.m + lane) * loadOne(mass + massPlace(node, lane));
                    const std::size_t at = place(node, lane);
                    store3(load3(f + at) - load3(v + at) * alphaMass, f + at);
                });
}

void AddForces(double* sums, double step, BodyVectors b, int nodes)
{
    const V h = hn::Set(D(), step);
    forEachNode(nodes,
                [&](int node, int lane)
                {
                    const std::size_t at = place(node, lane);
                    store3((load3(b + at) + takeSum(sums, node, lane)) * h, b + at);
                });
}

void AddInertia(double* sums, const double* mass, const PerLane& factor, const LaneProduct& v, PerLane& products)
{
    sumOverNodes(v.m_nodes, products,
                 [&](int node, int lane)
                 {
                     const V scaledMass = loadOne(factor.m + lane) * loadOne(mass + massPlace(node, lane));
                     const std::size_t at = place(node, lane);
                     const V3 sum = takeSum(sums, node, lane), p = load3(v.m_p + at);
                     const V3 Ap = {hn::MulAdd(scaledMass, p.x, sum.x), hn::MulAdd(scaledMass, p.y, sum.y),
                                    hn::MulAdd(scaledMass, p.z, sum.z)};
                     store3(Ap, v.m_Ap + at);
                     return dot(p, Ap);
                 });
}

}  // namespace HWY_NAMESPACE
}  // namespace bullet_fem
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace bullet_fem
{

HWY_EXPORT(DotLanes);
HWY_EXPORT(SquareInOrder);
HWY_EXPORT(SubtractLanes);
HWY_EXPORT(ContinueLanes);
HWY_EXPORT(AddLanes);
HWY_EXPORT(SubtractProduct);
HWY_EXPORT(ClearOthers);
HWY_EXPORT(ScaleGuess);
HWY_EXPORT(TurnDirection);
HWY_EXPORT(AdvanceAlong);
HWY_EXPORT(SubtractDamping);
HWY_EXPORT(AddForces);
HWY_EXPORT(AddInertia);

PerLane dotLanes(ConstBodyVectors a, ConstBodyVectors b, int nodes)
{
    PerLane sum;
    HWY_DYNAMIC_DISPATCH(DotLanes)(a, b, nodes, sum);
    return sum;
}

PerLane squareInOrder(ConstBodyVectors a, int nodes)
{
    PerLane sum;
    HWY_DYNAMIC_DISPATCH(SquareInOrder)(a, nodes, sum);
    return sum;
}

void subtractLanes(ConstBodyVectors a, ConstBodyVectors b, BodyVectors out, int nodes)
{
    HWY_DYNAMIC_DISPATCH(SubtractLanes)(a, b, out, nodes);
}

void continueLanes(ConstBodyVectors a, ConstBodyVectors b, BodyVectors out, int nodes)
{
    HWY_DYNAMIC_DISPATCH(ContinueLanes)(a, b, out, nodes);
}

void addLanes(ConstBodyVectors b, BodyVectors a, int nodes)
{
    HWY_DYNAMIC_DISPATCH(AddLanes)(b, a, nodes);
}

PerLane subtractProduct(const LaneRecurrence& v)
{
    PerLane squares;
    HWY_DYNAMIC_DISPATCH(SubtractProduct)(v, squares);
    return squares;
}

void clearOthers(const PerLane& kept, BodyVectors a, int nodes)
{
    HWY_DYNAMIC_DISPATCH(ClearOthers)(kept, a, nodes);
}

PerLane scaleGuess(const LaneRecurrence& v, const PerLane& scale)
{
    PerLane squares;
    HWY_DYNAMIC_DISPATCH(ScaleGuess)(v, scale, squares);
    return squares;
}

void turnDirection(const LaneRecurrence& v, ConstBodyVectors z, const PerLane& beta)
{
    HWY_DYNAMIC_DISPATCH(TurnDirection)(v, z, beta);
}

PerLane advanceAlong(const LaneRecurrence& v, const PerLane& step)
{
    PerLane squares;
    HWY_DYNAMIC_DISPATCH(AdvanceAlong)(v, step, squares);
    return squares;
}

void subtractDamping(const double* mass, ConstBodyVectors v, const PerLane& alpha, BodyVectors f, int nodes)
{
    HWY_DYNAMIC_DISPATCH(SubtractDamping)(mass, v, alpha, f, nodes);
}

void addForces(double* sums, double step, BodyVectors b, int nodes)
{
    HWY_DYNAMIC_DISPATCH(AddForces)(sums, step, b, nodes);
}

PerLane addInertia(double* sums, const double* mass, const PerLane& factor, const LaneProduct& v)
{
    PerLane products;
    HWY_DYNAMIC_DISPATCH(AddInertia)(sums, mass, factor, v, products);
    return products;
}

}  // namespace bullet_fem
#endif

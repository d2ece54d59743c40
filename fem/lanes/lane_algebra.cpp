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

// Four sums, so that an addition need not wait for the one before it.
HWY_INLINE V dotOfRange(ConstBodyVectors a, ConstBodyVectors b, Range nodes, int lane)
{
    V sum[4];
    for (V& s : sum) s = hn::Zero(D());
    int i = nodes.m_begin;
    for (; i + 4 <= nodes.m_end; i += 4)
    {
        HWY_UNROLL(4)
        for (int k = 0; k < 4; ++k) sum[k] = sum[k] + dotAt(a, b, place(i + k, lane));
    }
    for (; i < nodes.m_end; ++i) sum[0] = sum[0] + dotAt(a, b, place(i, lane));
    return (sum[0] + sum[1]) + (sum[2] + sum[3]);
}

void DotLanes(ConstBodyVectors a, ConstBodyVectors b, int nodes, PerLane& out)
{
    const Pieces pieces(nodes, kEntriesOfPiece);
    for (int lane = 0; lane < kBodyLanes; lane += kN)
    {
        V sum = hn::Zero(D());
        for (int k = 0; k < pieces.count(); ++k) sum = sum + dotOfRange(a, b, pieces[k], lane);
        hn::Store(sum, D(), out.m + lane);
    }
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

/// Writes where the body is active.
HWY_INLINE void storeActive(const LaneRecurrence& v, V value, int lane, double* to)
{
    const auto active = loadOne(v.m_active.m + lane) > hn::Zero(D());
    hn::Store(hn::IfThenElse(active, value, loadOne(to)), D(), to);
}

void SubtractProduct(const LaneRecurrence& v)
{
    forEachNumber(v.m_nodes, [&](std::size_t at, int lane)
                  { storeActive(v, loadOne(v.m_b + at) - loadOne(v.m_Ap + at), lane, v.m_r + at); });
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

void ScaleGuess(const LaneRecurrence& v, const PerLane& scale)
{
    const V zero = hn::Zero(D());
    forEachNumber(v.m_nodes,
                  [&](std::size_t at, int lane)
                  {
                      const V s = loadOne(scale.m + lane), b = loadOne(v.m_b + at);
                      storeActive(v, loadOne(v.m_x + at) * s, lane, v.m_x + at);
                      const V r = b - loadOne(v.m_Ap + at) * s;
                      storeActive(v, hn::IfThenElse(s > zero, r, b), lane, v.m_r + at);
                  });
}

void TurnDirection(const LaneRecurrence& v, ConstBodyVectors z, const PerLane& beta)
{
    const V zero = hn::Zero(D());
    forEachNumber(v.m_nodes,
                  [&](std::size_t at, int lane)
                  {
                      const V b = loadOne(beta.m + lane), zi = loadOne(z + at);
                      const V turned = zi + loadOne(v.m_p + at) * b;
                      storeActive(v, hn::IfThenElse(b > zero, turned, zi), lane, v.m_p + at);
                  });
}

void AdvanceAlong(const LaneRecurrence& v, const PerLane& step)
{
    forEachNumber(v.m_nodes,
                  [&](std::size_t at, int lane)
                  {
                      const V s = loadOne(step.m + lane);
                      storeActive(v, loadOne(v.m_x + at) + loadOne(v.m_p + at) * s, lane, v.m_x + at);
                      storeActive(v, loadOne(v.m_r + at) + loadOne(v.m_Ap + at) * hn::Neg(s), lane, v.m_r + at);
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

void AddInertia(double* sums, const double* mass, const PerLane& factor, ConstBodyVectors p, BodyVectors out, int nodes)
{
    forEachNode(nodes,
                [&](int node, int lane)
                {
                    const V scaledMass = loadOne(factor.m + lane) * loadOne(mass + massPlace(node, lane));
                    const std::size_t at = place(node, lane);
                    const V3 sum = takeSum(sums, node, lane), pi = load3(p + at);
                    store3({hn::MulAdd(scaledMass, pi.x, sum.x), hn::MulAdd(scaledMass, pi.y, sum.y),
                            hn::MulAdd(scaledMass, pi.z, sum.z)},
                           out + at);
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

void subtractProduct(const LaneRecurrence& v)
{
    HWY_DYNAMIC_DISPATCH(SubtractProduct)(v);
}

void clearOthers(const PerLane& kept, BodyVectors a, int nodes)
{
    HWY_DYNAMIC_DISPATCH(ClearOthers)(kept, a, nodes);
}

void scaleGuess(const LaneRecurrence& v, const PerLane& scale)
{
    HWY_DYNAMIC_DISPATCH(ScaleGuess)(v, scale);
}

void turnDirection(const LaneRecurrence& v, ConstBodyVectors z, const PerLane& beta)
{
    HWY_DYNAMIC_DISPATCH(TurnDirection)(v, z, beta);
}

void advanceAlong(const LaneRecurrence& v, const PerLane& step)
{
    HWY_DYNAMIC_DISPATCH(AdvanceAlong)(v, step);
}

void subtractDamping(const double* mass, ConstBodyVectors v, const PerLane& alpha, BodyVectors f, int nodes)
{
    HWY_DYNAMIC_DISPATCH(SubtractDamping)(mass, v, alpha, f, nodes);
}

void addForces(double* sums, double step, BodyVectors b, int nodes)
{
    HWY_DYNAMIC_DISPATCH(AddForces)(sums, step, b, nodes);
}

void addInertia(double* sums, const double* mass, const PerLane& factor, ConstBodyVectors p, BodyVectors out, int nodes)
{
    HWY_DYNAMIC_DISPATCH(AddInertia)(sums, mass, factor, p, out, nodes);
}

}  // namespace bullet_fem
#endif

// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "bullet_bridge/rigid/multibody_row.h"

namespace bullet_fem
{
namespace
{

// Calls visit(body, first) for both sides that are multibodies; `first`: index of the row's Jacobian.
template <class Visit>
void forEachMultiBody(const MultiBodyRow& row, const Visit& visit)
{
    if (row.m_multiBodyA) visit(*row.m_multiBodyA, row.m_jacAindex);
    if (row.m_multiBodyB) visit(*row.m_multiBodyB, row.m_jacBindex);
}

}  // namespace

double velocityOf(const btMultiBodyJacobianData& data, const MultiBodyRow& row)
{
    double sum = 0;
    forEachMultiBody(row,
                     [&](const btMultiBody& body, int first)
                     {
                         for (int k = 0; k < coordinatesOf(body); ++k)
                             sum += double(data.m_jacobians[first + k]) * double(body.getVelocityVector()[k]);
                     });
    return sum;
}

bool isFiniteRow(const btMultiBodyJacobianData& data, const MultiBodyRow& row)
{
    bool isFiniteSoFar = true;
    forEachMultiBody(row,
                     [&](const btMultiBody& body, int first)
                     {
                         for (int k = first; k < first + coordinatesOf(body); ++k)
                             isFiniteSoFar = isFiniteSoFar && std::isfinite(double(data.m_jacobians[k])) &&
                                             std::isfinite(double(data.m_deltaVelocitiesUnitImpulse[k]));
                     });
    return isFiniteSoFar;
}

void setImpulse(const btMultiBodyJacobianData& data, const MultiBodyRow& row, double impulse)
{
    row.m_appliedImpulse = btScalar(impulse);
    forEachMultiBody(row, [&](btMultiBody& body, int first)
                     { body.applyDeltaVeeMultiDof2(&data.m_deltaVelocitiesUnitImpulse[first], btScalar(impulse)); });
}

}  // namespace bullet_fem

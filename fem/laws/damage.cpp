// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "fem/laws/damage.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "fem/laws/hooke.h"

namespace bullet_fem
{
namespace
{

/// Largest damage [-]: a broken element keeps a thousandth of its stiffness, and A stays definite.
constexpr double kMaxDamage = 0.999;
/// Smallest softening strain over kappa_0 [-], for elements of more energy than G: they break at once.
constexpr double kMinSoftening = 0.05;

double equivalentStrain(const Mat3& e)
{
    Eigen::Matrix3d symmetric;
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) symmetric(i, j) = e(i, j);
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(symmetric, Eigen::EigenvaluesOnly);
    return eigen.eigenvalues().cwiseMax(0).norm();
}

double damageOf(const LawPoint& point)
{
    const double strength = point.m_constants[0], fractureEnergy = point.m_constants[1];
    const double least = strength / LameModuli{point.m_mu, point.m_lambda}.youngModulus(), most = point.m_history[0];
    if (!(most > least)) return 0;
    const double softening = std::max(kMinSoftening * least, fractureEnergy / (strength * point.m_size) - 0.5 * least);
    return std::min(kMaxDamage, 1 - least / most * std::exp(-(most - least) / softening));
}

LawResponse damagedResponse(const Mat3& e, const LawPoint& point)
{
    const double left = 1 - damageOf(point);
    LawResponse result = hookeResponse(e, point);
    result.m_stress *= left;
    result.m_bulk *= left;
    result.m_shear = left;
    result.m_energy *= left;
    return result;
}

}  // namespace

Law damageLaw()
{
    Law law = {};
    law.m_name = "damage";
    law.m_title = "damage law";
    law.m_kind = LawKind::varying;
    law.m_noPatches = "is for compressible solids, whose elements lose their stiffness one by one";
    law.m_constants = {{"strength", "Pa", 3e6, 1, 1e13, "concrete has 3e6 in tension"},
                       {"fractureEnergy", "J/m2", 100, 1e-6, 1e9, "concrete has 100"}};
    law.m_historyCount = 1;
    law.m_moduli = [](const double*, double young, double poisson) { return lameModuli(young, poisson); };
    law.m_respond = &damagedResponse;
    law.m_advance = [](const Mat3& e, const LawPoint&, double* history)
    { history[0] = std::max(history[0], equivalentStrain(e)); };
    return law;
}

}  // namespace bullet_fem

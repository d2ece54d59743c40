// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "fem/laws/ogden.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "fem/common/message.h"
#include "fem/laws/volume_ratio.h"

namespace bullet_fem
{
namespace
{

constexpr int kOgdenTerms = 3;
constexpr double kMaxModulusOfTerm = 1e13;  // [Pa], as Young's modulus
constexpr double kMaxExponent = 30;         // [-]; at a stretch of 10 the term is 1e30 times mu_p
constexpr double kMinStretch = 0.1;         // [-], as kMinVolumeRatio

/// sum over p of mu_p / alpha_p (stretch^alpha_p - 1) - mu_p (stretch - 1) and its derivatives, for e = stretch - 1.
struct StretchFunction
{
    StretchFunction(const double* constants, double e)
    {
        const double above = std::max(e, kMinStretch - 1), below = e - above, logarithm = std::log1p(above);
        for (int p = 0; p < kOgdenTerms; ++p)
        {
            const double mu = constants[2 * p], alpha = constants[2 * p + 1];
            if (mu == 0) continue;
            m_value += mu * (std::expm1(alpha * logarithm) / alpha - above);
            m_slope += mu * std::expm1((alpha - 1) * logarithm);
            m_curvature += mu * (alpha - 1) * std::exp((alpha - 2) * logarithm);
        }
        if (below < 0) m_curvature = std::max(0.0, m_curvature);
        m_value += (m_slope + 0.5 * m_curvature * below) * below;
        m_slope += m_curvature * below;
    }

    double m_value = 0, m_slope = 0, m_curvature = 0;
};

LawResponse respond(const Mat3& e, const LawPoint& point)
{
    const double* constants = point.m_constants;
    const double M = constants[0] + constants[2] + constants[4];
    Eigen::Matrix3d symmetric;
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) symmetric(i, j) = e(i, j);
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(symmetric);
    LawResponse result;
    double steepest = 0, longest = 0;
    for (int i = 0; i < 3; ++i)
    {
        const StretchFunction f(constants, eigen.eigenvalues()(i));
        const Vec3 n = {eigen.eigenvectors()(0, i), eigen.eigenvectors()(1, i), eigen.eigenvectors()(2, i)};
        result.m_stress += f.m_slope * outer(n, n);
        result.m_energy += f.m_value;
        steepest = std::max(steepest, f.m_curvature);
        longest = std::max(longest, 1 + eigen.eigenvalues()(i));
    }
    const Mat3 adjugate = adjugateOf(e);
    const double tr = trace(e), j = tr + trace(adjugate) + determinant(e);
    result.m_cofactor = Mat3::diagonal(1 + tr) - e + adjugate;
    const VolumeFunction volume(j);
    // -M ln J, and its parabola; M (tr(e) - j) is what StretchFunction leaves out.
    const double above = std::max(j, kMinVolumeRatio - 1), below = j - above, inverse = 1 / (1 + above);
    const double slope = M * (above + inverse * below) * inverse;  // of M (J - ln J)
    const double q = point.m_lambda * volume.m_slope + slope + point.m_pressure;
    result.m_stress += q * result.m_cofactor + M * (Mat3::identity() - result.m_cofactor);
    result.m_energy += point.m_lambda * volume.m_value + M * tr +
                       M * (-std::log1p(above) + (-1 + 0.5 * inverse * below) * inverse * below);
    const double curvature = point.m_lambda * volume.m_curvature + M * inverse * inverse;
    const double squares = std::max(squaredNorm(result.m_cofactor), 1e-30), traceOfC = trace(result.m_cofactor);
    const double likeness = 0.5 * (traceOfC * traceOfC / squares - 1);
    result.m_bulk = std::max(0.0, curvature - 3 * M * likeness * likeness / squares);
    result.m_shear = std::max(1.0, 0.5 * (steepest + std::fabs(q - M) * std::max(0.0, longest)) / point.m_mu);
    return result;
}

bool isConsistent(const double* constants, std::string* why)
{
    double modulus = 0;
    for (int p = 0; p < kOgdenTerms; ++p)
    {
        const double mu = constants[2 * p], alpha = constants[2 * p + 1];
        modulus += 0.5 * mu * alpha;
        if (mu == 0 || mu * alpha > 0) continue;
        if (why)
            *why = message("Ogden's law: mu", p + 1, " alpha", p + 1, " [Pa] is ", mu * alpha, ", not in (0, inf): mu",
                           p + 1, " is ", mu, " and alpha", p + 1, " ", alpha,
                           "; give both one sign, or mu 0 for a term that is not there");
        return false;
    }
    if (modulus > 0) return true;
    if (why)
        *why = "Ogden's law: the shear modulus 1/2 sum mu_p alpha_p [Pa] is 0, not in (0, inf); give mu1 and alpha1";
    return false;
}

}  // namespace

Law ogdenLaw()
{
    Law law = {};
    law.m_name = "ogden";
    law.m_title = "Ogden's law";
    law.m_kind = LawKind::varying;
    law.m_hasVolumeRatio = true;
    constexpr const char* kNames[][2] = {{"mu1", "alpha1"}, {"mu2", "alpha2"}, {"mu3", "alpha3"}};
    constexpr double kRubber[][2] = {{6.18e5, 1.3}, {1.18e3, 5}, {-9.81e3, -2}};  // Treloar's [Ogden 1972]
    for (int p = 0; p < kOgdenTerms; ++p)
    {
        const double most = kMaxModulusOfTerm;
        law.m_constants.push_back({kNames[p][0], "Pa", kRubber[p][0], -most, most, "rubber has some 1e5"});
        law.m_constants.push_back(
            {kNames[p][1], "-", kRubber[p][1], -kMaxExponent, kMaxExponent, "rubber has -2 to 8"});
    }
    law.m_moduli = [](const double* constants, double, double nu)
    {
        double mu = 0;
        for (int p = 0; p < kOgdenTerms; ++p) mu += 0.5 * constants[2 * p] * constants[2 * p + 1];
        return LameModuli{mu, 2 * mu * nu / (1 - 2 * nu)};
    };
    law.m_respond = &respond;
    law.m_isConsistent = &isConsistent;
    return law;
}

}  // namespace bullet_fem

// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "bullet_fem/fem/laws/orthotropic.h"

#include <cmath>

#include "fem/common/message.h"
#include "fem/laws/orthotropic_law.h"

namespace bullet_fem
{
namespace
{

constexpr int kPair[3][2] = {{0, 1}, {0, 2}, {1, 2}};  // 12, 13, 23, the order of m_poisson and m_shear
constexpr const char* kPairName[3] = {"12", "13", "23"};

/// The ratios n_ij of the compliance scaled to a unit diagonal.
struct ScaledRatios
{
    explicit ScaledRatios(const Orthotropic& m)
    {
        for (int k = 0; k < 3; ++k)
            m_n[k] = m.m_poisson[k] * std::sqrt(m.m_young[kPair[k][1]] / m.m_young[kPair[k][0]]);
    }

    double determinant() const
    {
        const double a = m_n[0], b = m_n[1], c = m_n[2];
        return 1 - a * a - b * b - c * c - 2 * a * b * c;
    }

    double m_n[3];
};

bool refuse(std::string* why, const std::string& text)
{
    if (why) *why = text;
    return false;
}

bool validModulus(const char* name, double value, std::string* why)
{
    if (value > 0 && value <= Orthotropic::kMaxModulus) return true;  // false for NaN
    return refuse(why, message("orthotropic ", name, " [Pa] is ", value, ", outside (0, ", Orthotropic::kMaxModulus,
                               "]; give what a bar has along that axis, wood some 1e8 to 1e10"));
}

// Requires positive Young's moduli.
bool validRatio(const Orthotropic& m, int k, std::string* why)
{
    const double first = m.m_young[kPair[k][0]], second = m.m_young[kPair[k][1]], bound = std::sqrt(first / second);
    if (std::fabs(m.m_poisson[k]) < bound) return true;
    const std::string name = kPairName[k];
    return refuse(why, message("orthotropic nu", name, " [-] is ", m.m_poisson[k], ", outside (", -bound, ", ", bound,
                               "), which |nu", name, "| < sqrt(E", name[0], " / E", name[1], ") asks for; is it nu",
                               name[1], name[0], " = nu", name, " E", name[1], " / E", name[0], " of your table?"));
}

bool validDirections(const Orthotropic& m, std::string* why)
{
    const auto text = [](const Vec3& v) { return message("(", v.x, ", ", v.y, ", ", v.z, ")"); };
    const double along = norm(m.m_along), across = norm(m.m_across);
    for (const Vec3* v : {&m.m_along, &m.m_across})
        if (!isFinite(*v) || !(norm(*v) > 0) || !std::isfinite(norm(*v)))
            return refuse(why, message("orthotropic direction of axis ", v == &m.m_along ? 1 : 2, " is ", text(*v),
                                       ", without a length in (0, inf); give a direction such as (1, 0, 0)"));
    const double sine = norm(cross((1 / along) * m.m_along, (1 / across) * m.m_across));
    if (sine >= Orthotropic::kMinSine) return true;
    return refuse(why, message("orthotropic directions of axes 1 and 2 are ", text(m.m_along), " and ",
                               text(m.m_across), ", parallel; give for axis 2 one across axis 1"));
}

// True if A has positive pivots in Cholesky's factorization.
bool isPositiveDefinite(ElasticMatrix A)
{
    for (int k = 0; k < 6; ++k)
    {
        if (!(A(k, k) > 0)) return false;
        for (int i = k + 1; i < 6; ++i)
            for (int j = k + 1; j < 6; ++j) A(i, j) -= A(i, k) * A(k, j) / A(k, k);
    }
    return true;
}

// Voigt average: bulk and shear modulus from the two linear invariants of C.
LameModuli meanOverDirections(const ElasticMatrix& C)
{
    const double normal = C(0, 0) + C(1, 1) + C(2, 2), across = C(0, 1) + C(0, 2) + C(1, 2);
    const double mu = (normal - across + 3 * (C(3, 3) + C(4, 4) + C(5, 5))) / 15;
    return {mu, (normal + 2 * across) / 9 - 2.0 / 3 * mu};
}

int voigt(int i, int j)
{
    return i == j ? i : 6 - i - j;
}

}  // namespace

ElasticMatrix isotropicStiffness(const LameModuli& moduli)
{
    const double lambda = moduli.m_lambda, mu = moduli.m_mu;
    ElasticMatrix C;
    for (int i = 0; i < 3; ++i)
    {
        for (int j = 0; j < 3; ++j) C(i, j) = lambda + (i == j ? 2 * mu : 0);
        C(3 + i, 3 + i) = mu;
    }
    return C;
}

SymmetricTensor stressOf(const ElasticMatrix& C, const SymmetricTensor& strain)
{
    const double e[6] = {strain.xx, strain.yy, strain.zz, 2 * strain.yz, 2 * strain.xz, 2 * strain.xy};
    double s[6] = {};
    for (int i = 0; i < 6; ++i)
        for (int j = 0; j < 6; ++j) s[i] += C(i, j) * e[j];
    return {s[0], s[1], s[2], s[5], s[3], s[4]};
}

Orthotropic Orthotropic::transverselyIsotropic(double youngAlong, double youngAcross, double poissonAlong,
                                               double poissonAcross, double shearAlong)
{
    Orthotropic m;
    m.m_young = {youngAlong, youngAcross, youngAcross};
    m.m_poisson = {poissonAlong, poissonAlong, poissonAcross};
    m.m_shear = {shearAlong, shearAlong, youngAcross / (2 * (1 + poissonAcross))};
    return m;
}

bool Orthotropic::valid(std::string* why) const
{
    constexpr const char* kYoung[3] = {"E1", "E2", "E3"};
    constexpr const char* kShear[3] = {"G12", "G13", "G23"};
    for (int i = 0; i < 3; ++i)
        if (!validModulus(kYoung[i], m_young[i], why)) return false;
    for (int k = 0; k < 3; ++k)
        if (!validRatio(*this, k, why)) return false;
    for (int k = 0; k < 3; ++k)
        if (!validModulus(kShear[k], m_shear[k], why)) return false;
    const double determinant = ScaledRatios(*this).determinant();
    if (!(determinant > kMinDeterminant))
        return refuse(
            why, message("orthotropic 1 - nu12 nu21 - nu13 nu31 - nu23 nu32 - 2 nu21 nu32 nu13 is ", determinant,
                         ", not above ", kMinDeterminant, " with nu12, nu13, nu23 = ", m_poisson[0], ", ", m_poisson[1],
                         ", ", m_poisson[2], ": some strain would have no energy; give smaller Poisson's ratios"));
    return validDirections(*this, why);
}

Mat3 Orthotropic::axes() const
{
    const Vec3 first = (1 / norm(m_along)) * m_along;
    const Vec3 third = cross(first, (1 / norm(m_across)) * m_across), unit = (1 / norm(third)) * third;
    return Mat3::fromColumns(first, cross(unit, first), unit);
}

double Orthotropic::compliance(const Vec3& direction) const
{
    const Vec3 cosines = transposeTimes(axes(), direction);
    const double squares[3] = {cosines.x * cosines.x, cosines.y * cosines.y, cosines.z * cosines.z};
    double sum = 0;
    for (int i = 0; i < 3; ++i) sum += squares[i] * squares[i] / m_young[i];
    for (int k = 0; k < 3; ++k)
        sum += (1 / m_shear[k] - 2 * m_poisson[k] / m_young[kPair[k][0]]) * squares[kPair[k][0]] * squares[kPair[k][1]];
    return sum;
}

ElasticMatrix Orthotropic::stiffness() const
{
    // In the material's own axes: the compliance S has entries 1 / E_i and -nu_ij / E_i; scaled to a unit diagonal it
    // is inverted by cofactors.
    const ScaledRatios ratios(*this);
    const double a = ratios.m_n[0], b = ratios.m_n[1], c = ratios.m_n[2], scale = 1 / ratios.determinant();
    const double cofactor[3][3] = {
        {1 - c * c, a + b * c, b + a * c}, {a + b * c, 1 - b * b, c + a * b}, {b + a * c, c + a * b, 1 - a * a}};
    double own[3][3][3][3] = {};  // C_ijkl
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j)
            own[i][i][j][j] = scale * cofactor[i][j] * std::sqrt(m_young[i]) * std::sqrt(m_young[j]);
    for (int k = 0; k < 3; ++k)
    {
        const int i = kPair[k][0], j = kPair[k][1];
        own[i][j][i][j] = own[i][j][j][i] = own[j][i][i][j] = own[j][i][j][i] = m_shear[k];
    }
    // C_ijkl = sum over the axes p, q, r, s of A_ip A_jq A_kr A_ls C_pqrs, of which few are nonzero.
    const Mat3 A = axes();
    ElasticMatrix C;
    for (int i = 0; i < 3; ++i)
        for (int j = i; j < 3; ++j)
            for (int k = 0; k < 3; ++k)
                for (int l = k; l < 3; ++l)
                {
                    double sum = 0;
                    for (int p = 0; p < 3; ++p)
                        for (int q = 0; q < 3; ++q)
                            for (int r = 0; r < 3; ++r)
                                for (int s = 0; s < 3; ++s)
                                    if (own[p][q][r][s] != 0)
                                        sum += A(i, p) * A(j, q) * A(k, r) * A(l, s) * own[p][q][r][s];
                    C(voigt(i, j), voigt(k, l)) = sum;
                }
    for (int i = 0; i < 6; ++i)
        for (int j = 0; j < i; ++j) C(i, j) = C(j, i);  // exactly symmetric
    return C;
}

LameModuli Orthotropic::isotropicPart() const
{
    constexpr int kHalvings = 50;  // to rounding of double precision
    const ElasticMatrix C = stiffness();
    const LameModuli mean = meanOverDirections(C);
    double low = 0, high = 1;
    for (int k = 0; k < kHalvings; ++k)
    {
        const double t = 0.5 * (low + high);
        ElasticMatrix rest = isotropicStiffness({t * mean.m_mu, t * mean.m_lambda});
        for (int i = 0; i < 6; ++i)
            for (int j = 0; j < 6; ++j) rest(i, j) = C(i, j) - rest(i, j);
        (isPositiveDefinite(rest) ? low : high) = t;
    }
    return {low * mean.m_mu, low * mean.m_lambda};
}

Law orthotropicLaw()
{
    Law law = {};
    law.m_name = "orthotropic";
    law.m_title = "orthotropic law";
    law.m_kind = LawKind::anisotropic;
    law.m_noPatches = "has no pressure of its own";
    law.m_respond = [](const Mat3& e, const LawPoint& point)
    {
        const SymmetricTensor strain = symmetricPart(e), stress = stressOf(*point.m_stiffness, strain);
        LawResponse result;
        result.m_stress = toMatrix(stress);
        result.m_energy = 0.5 * contraction(stress, strain);
        return result;
    };
    return law;
}

}  // namespace bullet_fem

// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "benchmarks/reference/warped_elements.h"

#include "benchmarks/reference/positive_part.h"
#include "fem/common/rotation.h"

namespace bullet_fem
{
namespace
{

// sum over a of (p_a - p_0) g_a^T: the deformation gradient if p are positions.
Mat3 gradient(const RestElement& element, const Tet& tet, const std::vector<Vec3>& p)
{
    const Vec3& p0 = p[tet[0]];
    return Mat3::fromColumns(p[tet[1]] - p0, p[tet[2]] - p0, p[tet[3]] - p0) * element.m_DmInverse;
}

// force_a += P g_a for the four nodes, P = stress times volume.
void scatter(const RestElement& element, const Tet& tet, const Mat3& P, std::vector<Vec3>& force)
{
    const Mat3 columns = timesTranspose(P, element.m_DmInverse);
    const Vec3 f1 = columns.column(0), f2 = columns.column(1), f3 = columns.column(2);
    force[tet[1]] += f1;
    force[tet[2]] += f2;
    force[tet[3]] += f3;
    force[tet[0]] -= f1 + f2 + f3;
}

// 2 mu V dev(E) + (lambda + 2/3 mu) V dilatation I.
Mat3 hooke(const RestElement& element, const Mat3& E, double dilatation)
{
    const double mu = element.m_muVolume,
                 pressure = element.m_lambdaVolume * dilatation + 2.0 / 3 * mu * (dilatation - trace(E));
    const double xy = mu * (E(0, 1) + E(1, 0)), xz = mu * (E(0, 2) + E(2, 0)), yz = mu * (E(1, 2) + E(2, 1));
    return {{{2 * mu * E(0, 0) + pressure, xy, xz},
             {xy, 2 * mu * E(1, 1) + pressure, yz},
             {xz, yz, 2 * mu * E(2, 2) + pressure}}};
}

// Trace of each element's strain, or its mean over the element's patch.
template <class StrainOf>
std::vector<double> dilatations(const RestShape& shape, const StrainOf& strainOf)
{
    const int tets = shape.m_mesh.tetCount();
    std::vector<double> own(tets);
    for (int e = 0; e < tets; ++e) own[e] = trace(strainOf(e));
    if (shape.m_patches.empty()) return own;
    std::vector<double> sum(shape.m_patches.count(), 0.0), volume(sum);
    for (int e = 0; e < tets; ++e)
    {
        const int p = shape.m_patches.m_patch[e];
        sum[p] += shape.m_elements[e].m_volume * own[e];
        volume[p] += shape.m_elements[e].m_volume;
    }
    for (int e = 0; e < tets; ++e) own[e] = sum[shape.m_patches.m_patch[e]] / volume[shape.m_patches.m_patch[e]];
    return own;
}

std::array<double, 6> packed(const Mat3& s)
{
    return {s(0, 0), s(1, 1), s(2, 2), s(1, 2), s(0, 2), s(0, 1)};
}

Mat3 unpacked(const std::array<double, 6>& s)
{
    return {{{s[0], s[5], s[4]}, {s[5], s[1], s[3]}, {s[4], s[3], s[2]}}};
}

}  // namespace

void updateElementRotations(const RestShape& shape, const std::vector<Vec3>& x, std::vector<Mat3>& R)
{
    const std::vector<Tet>& tets = shape.m_mesh.tets();
    for (std::size_t e = 0; e < tets.size(); ++e) R[e] = polarRotation(gradient(shape.m_elements[e], tets[e], x), R[e]);
}

void addElasticForces(const RestShape& shape, const std::vector<Vec3>& x, const std::vector<Vec3>& v, double damping,
                      const std::vector<Mat3>& R, std::vector<Vec3>& force, std::vector<std::array<double, 6>>* tension)
{
    const std::vector<Tet>& tets = shape.m_mesh.tets();
    const auto turned = [&](const std::vector<Vec3>& p, std::size_t e)
    { return transposeTimes(R[e], gradient(shape.m_elements[e], tets[e], p)); };
    const std::vector<double> dilatation =
        dilatations(shape, [&](std::size_t e) { return turned(x, e) - Mat3::identity(); });
    const std::vector<double> rate = dilatations(shape, [&](std::size_t e) { return turned(v, e); });
    for (std::size_t e = 0; e < tets.size(); ++e)
    {
        const RestElement& element = shape.m_elements[e];
        const Mat3 elastic = hooke(element, turned(x, e) - Mat3::identity(), dilatation[e]);
        const Mat3 viscous = hooke(element, turned(v, e), rate[e]);
        scatter(element, tets[e], -1.0 * (R[e] * (elastic + damping * viscous)), force);
        if (tension) (*tension)[e] = packed(positivePart(elastic));
    }
}

void addStiffnessProduct(const RestShape& shape, const std::vector<Mat3>& R,
                         const std::vector<std::array<double, 6>>& tension, const std::array<double, 2>& factors,
                         const std::vector<Vec3>& p, std::vector<Vec3>& out)
{
    const std::vector<Tet>& tets = shape.m_mesh.tets();
    const std::vector<double> dilatation = dilatations(
        shape, [&](std::size_t e) { return transposeTimes(R[e], gradient(shape.m_elements[e], tets[e], p)); });
    for (std::size_t e = 0; e < tets.size(); ++e)
    {
        const RestElement& element = shape.m_elements[e];
        const Mat3 G = gradient(element, tets[e], p);
        Mat3 P = factors[0] * (R[e] * hooke(element, transposeTimes(R[e], G), dilatation[e]));
        if (!tension.empty()) P += factors[1] * (G * unpacked(tension[e]));
        scatter(element, tets[e], P, out);
    }
}

}  // namespace bullet_fem

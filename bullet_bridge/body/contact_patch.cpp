// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "bullet_bridge/body/contact_patch.h"

#include <algorithm>
#include <cmath>

namespace bullet_fem
{
namespace
{

constexpr double kFlattest = 0.5;  // smallest curvature times size (cube root of the volume) of a round body; a ball
                                   // has 1.6
constexpr double kSizePower = 4;   // between flat sides the patch moves with the smaller one; between equal ones at the
                                   // mean velocity
constexpr double kMaxLag = 0.5;    // largest lag, in sizes of the smaller side [-]: some three quarters of a ball's
                                   // radius. A ball that turns by more in a step would have its weight beside itself.
                                   // Longer lags are shortened to a length that falls with the speed again: W has no
                                   // couples of impulses beside the nodes, and those of fast bodies gained energy from
                                   // step to step (ContactPatch, SpinningBodies).
constexpr double kMinInertia = 1e-9;  // regularization of the inertia over its trace, so that collinear nodes have a
                                      // spin

// Velocity of the side's centre of curvature [m/s], limited for bodies with few facets.
Vec3 velocityOfCentre(const ContactPatchSide& side, const Vec3& inward)
{
    if (!(side.m_curvature > 0)) return side.m_velocity;
    const Vec3 ahead = cross(side.m_spin, inward * (1 / side.m_curvature));
    const double square = dot(ahead, ahead);
    if (!side.m_ofMass || square == 0) return side.m_velocity + ahead;
    return side.m_velocity + std::clamp(dot(*side.m_ofMass - side.m_velocity, ahead) / square, 0.0, 1.0) * ahead;
}

}  // namespace

MeanMotion meanMotion(const Body& body)
{
    const BodyState& s = body.m_state;
    const TetMesh& mesh = body.m_model->mesh();
    const int n = mesh.nodeCount();
    if (mesh.componentCount() - mesh.looseCount() != 1) return {};
    double mass = 0;
    Vec3 center, velocity;
    for (int i = 0; i < n; ++i)
    {
        if (mesh.isLoose(i)) continue;
        if (s.m_fixed[i]) return {};
        mass += s.m_mass[i];
        center += s.m_mass[i] * s.m_x[i];
        velocity += s.m_mass[i] * s.m_v[i];
    }
    center *= 1 / mass;
    velocity *= 1 / mass;
    Vec3 angular;
    Mat3 inertia;
    for (int i = 0; i < n; ++i)
    {
        if (mesh.isLoose(i)) continue;
        const Vec3 r = s.m_x[i] - center;
        angular += s.m_mass[i] * cross(r, s.m_v[i]);
        inertia += s.m_mass[i] * (Mat3::diagonal(dot(r, r)) - outer(r, r));
    }
    const double size = trace(inertia);
    if (!(size > 0)) return {velocity, {}};
    return {velocity, inverse(inertia + Mat3::diagonal(kMinInertia * size)) * angular};
}

Vec3 patchLag(const ContactPatchSide& a, const ContactPatchSide& b, const Vec3& normal, double h)
{
    const double sum = a.m_curvature + b.m_curvature;
    // weight of a
    const double share = sum > 0 ? a.m_curvature / sum : 1 / (1 + std::pow(a.m_size / b.m_size, kSizePower));
    const Vec3 patch = share * velocityOfCentre(a, normal) + (1 - share) * velocityOfCentre(b, -normal);
    const Vec3 lag = h * (a.m_velocity - patch);
    const Vec3 across = lag - dot(lag, normal) * normal;
    const double most = kMaxLag * std::min(a.m_size, b.m_size), length = norm(across);
    const double excess = std::max(1.0, length / most);
    return (1 / (excess * excess)) * across;
}

double roundness(double curvature, double size)
{
    return curvature * size < kFlattest ? 0 : curvature;
}

}  // namespace bullet_fem

// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "bullet_bridge/body/pose_matching.h"

#include <algorithm>
#include <cmath>

#include "BulletSoftBody/btSoftBody.h"
#include "bullet_fem/bullet_bridge/vectors.h"
#include "fem/common/rotation.h"

namespace bullet_fem
{
namespace
{

constexpr double kLargestShare = 0.999;  // a share of 1 would need an infinite spring

/// Weighted least-squares fit of a rigid motion to vectors at the nodes.
class RigidFit
{
public:
    explicit RigidFit(const FemSoftBody& fem) : m_state(fem.m_body.m_state), m_mesh(fem.m_body.m_model->mesh())
    {
        double mass = 0;
        for (std::size_t i = 0; i < m_state.m_x.size(); ++i) mass += m_state.m_fixed[i] ? 0 : m_state.m_mass[i];
        m_pinWeight = mass > 0 ? 1000 * mass * static_cast<double>(m_state.m_x.size()) : 1;
        for (std::size_t i = 0; i < m_state.m_x.size(); ++i)
        {
            m_sum += weight(i);
            m_center += weight(i) * m_state.m_x[i];
        }
        m_center *= 1 / m_sum;
        Mat3 inertia;
        for (std::size_t i = 0; i < m_state.m_x.size(); ++i)
            inertia += weight(i) * (Mat3::diagonal(dot(arm(i), arm(i))) - outer(arm(i), arm(i)));
        const double size = trace(inertia);
        if (size > 0) m_inverseInertia = inverse(inertia + Mat3::diagonal(1e-14 * size));
    }

    struct Motion
    {
        Vec3 m_linear, m_angular;
    };

    /// Fits the motion to value(i) at each node i.
    template <class Value>
    Motion fit(const Value& value) const
    {
        Motion motion;
        for (std::size_t i = 0; i < m_state.m_x.size(); ++i)
        {
            const Vec3 weighted = weight(i) * value(i);
            motion.m_linear += weighted;
            motion.m_angular += cross(arm(i), weighted);
        }
        motion.m_linear *= 1 / m_sum;
        motion.m_angular = m_inverseInertia * motion.m_angular;
        return motion;
    }

    /// The rotation that aligns positions X(i) with the nodes; X may have any origin.
    template <class Place>
    Mat3 rotationOf(const Place& X) const
    {
        Vec3 middle;
        for (std::size_t i = 0; i < m_state.m_x.size(); ++i) middle += (weight(i) / m_sum) * X(i);
        Mat3 covariance;
        for (std::size_t i = 0; i < m_state.m_x.size(); ++i) covariance += weight(i) * outer(arm(i), X(i) - middle);
        const double size = std::sqrt(squaredNorm(covariance));
        return size > 0 ? polarRotation(1 / size * covariance, Mat3::identity()) : Mat3::identity();
    }

    Vec3 at(std::size_t i, const Motion& motion) const { return motion.m_linear + cross(motion.m_angular, arm(i)); }

private:
    double weight(std::size_t i) const
    {
        if (m_mesh.isLoose(static_cast<int>(i))) return 0;
        return m_state.m_fixed[i] ? m_pinWeight : m_state.m_mass[i];
    }
    Vec3 arm(std::size_t i) const { return m_state.m_x[i] - m_center; }

    const BodyState& m_state;
    const TetMesh& m_mesh;
    double m_pinWeight, m_sum = 0;
    Vec3 m_center;
    Mat3 m_inverseInertia;
};

bool isUsable(const btSoftBody& soft)
{
    const btSoftBody::Pose& pose = soft.m_pose;
    if (!pose.m_bframe || pose.m_pos.size() != soft.m_nodes.size() || pose.m_wgh.size() != soft.m_nodes.size())
        return false;
    for (int i = 0; i < pose.m_pos.size(); ++i)
        if (!isFinite(vec3(pose.m_pos[i]))) return false;
    return true;
}

}  // namespace

void matchPose(FemSoftBody& fem, double step)
{
    btSoftBody& soft = *fem.m_softBody;
    const BodyState& state = fem.m_body.m_state;
    StepLoads& loads = fem.m_body.m_loads;
    loads.m_frameDamping = 0;
    if (!isUsable(soft)) return;
    soft.updatePose();  // for programs that read the pose
    const double share = std::min<double>(soft.m_cfg.kMT, kLargestShare);
    if (!(share > 0)) return;

    const double rate = share / (step * (1 - share));  // h c / m [1/s]
    const double slowed = 1 / (1 + step * (fem.m_body.m_model->shape().m_material.m_massDamping + loads.m_massDamping));
    const RigidFit rigid(fem);
    const auto endVelocity = [&](std::size_t i)
    {
        return state.m_fixed[i] ? loads.m_targetVelocity[i]
                                : slowed * (state.m_v[i] + (step / state.m_mass[i]) * loads.m_force[i]);
    };
    // Bullet's own rotation is not used: a term against singular matrices biases it to the initial one if a node is
    // pinned.
    const auto place = [&](std::size_t i) { return vec3(soft.m_pose.m_pos[static_cast<int>(i)]); };
    const Mat3 R = rigid.rotationOf(place);
    const auto way = [&](std::size_t i) { return R * place(i) - state.m_x[i]; };
    const RigidFit::Motion velocity = rigid.fit(endVelocity), displacement = rigid.fit(way);
    for (std::size_t i = 0; i < state.m_x.size(); ++i)
    {
        loads.m_frameVelocity[i] = rigid.at(i, velocity);
        loads.m_force[i] += (rate * state.m_mass[i] / step) * (way(i) - rigid.at(i, displacement));
    }
    loads.m_frameDamping = rate;
    loads.m_leastDamping = 1;  // Bullet's law holds for its own steps, which are damped
}

}  // namespace bullet_fem

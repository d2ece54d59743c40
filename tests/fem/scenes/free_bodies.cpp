// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "fem/scenes/free_bodies.h"

#include <cmath>

namespace bullet_fem
{

TetMesh makeFreeBar(const std::array<int, 3>& cells)
{
    constexpr double kHeight = 0.03;
    return makeBox({kBarLength, kHeight, kHeight}, cells, {-kBarLength / 2, -kHeight / 2, -kHeight / 2},
                   CellSplit::kuhnSix);
}

Material barMaterial(double young, double stiffnessDamping)
{
    Material material = elasticMaterial(young, 0.3);
    material.m_stiffnessDamping = stiffnessDamping;
    return material;
}

void bend(Body& body, double angle)
{
    const double radius = kBarLength / angle;
    const std::vector<Vec3>& X = body.m_model->mesh().restPositions();
    for (std::size_t i = 0; i < X.size(); ++i)
    {
        const double phi = X[i].x / radius, own = radius - X[i].y;
        body.m_state.m_x[i] = {own * std::sin(phi), radius - own * std::cos(phi), X[i].z};
    }
}

void twist(Body& body, double angle)
{
    const std::vector<Vec3>& X = body.m_model->mesh().restPositions();
    for (std::size_t i = 0; i < X.size(); ++i)
        body.m_state.m_x[i] = rotationAbout({1, 0, 0}, angle * X[i].x / kBarLength) * X[i];
}

void rotate(Body& body, const Mat3& rotation)
{
    for (Vec3& x : body.m_state.m_x) x = rotation * x;
}

void spin(Body& body, const Vec3& omega)
{
    const Vec3 center = weightedMean(body.m_state.m_mass, body.m_state.m_x);
    for (std::size_t i = 0; i < body.m_state.m_x.size(); ++i)
        body.m_state.m_v[i] += cross(omega, body.m_state.m_x[i] - center);
}

RigidMotion rigidMotionOf(const Body& body, int component)
{
    const BodyState& s = body.m_state;
    const std::vector<int>& componentOf = body.m_model->mesh().nodeComponent();
    RigidMotion motion;
    for (std::size_t i = 0; i < s.m_x.size(); ++i)
    {
        if (componentOf[i] != component) continue;
        motion.m_mass += s.m_mass[i];
        motion.m_center += s.m_mass[i] * s.m_x[i];
    }
    motion.m_center *= 1 / motion.m_mass;
    for (std::size_t i = 0; i < s.m_x.size(); ++i)
    {
        if (componentOf[i] != component) continue;
        const Vec3 r = s.m_x[i] - motion.m_center, p = s.m_mass[i] * s.m_v[i];
        motion.m_linear += p;
        motion.m_angular += cross(r, p);
        motion.m_inertia += s.m_mass[i] * (Mat3::diagonal(dot(r, r)) - outer(r, r));
        motion.m_linearSize += norm(p);
        motion.m_angularSize += norm(r) * norm(p);
    }
    return motion;
}

void equilibrate(const Body& body, std::vector<Vec3>& impulses)
{
    const BodyState& s = body.m_state;
    const RigidMotion motion = rigidMotionOf(body);
    Vec3 sum, torque;
    for (std::size_t i = 0; i < impulses.size(); ++i)
    {
        sum += impulses[i];
        torque += cross(s.m_x[i] - motion.m_center, impulses[i]);
    }
    const Vec3 v = (1 / motion.m_mass) * sum, w = inverse(motion.m_inertia) * torque;
    for (std::size_t i = 0; i < impulses.size(); ++i)
        impulses[i] -= s.m_mass[i] * (v + cross(w, s.m_x[i] - motion.m_center));
}

std::string nameOfYoung(double young)
{
    return "1e" + std::to_string(std::lround(std::log10(young))) + "Pa";
}

std::string nameOfDamping(double numericalDamping)
{
    return numericalDamping == 1 ? "ImplicitEuler" : numericalDamping == 0 ? "SecondOrder" : "SomeDamping";
}

}  // namespace bullet_fem

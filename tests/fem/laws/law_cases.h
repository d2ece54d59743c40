// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <array>

#include "fem/laws/law.h"
#include "fem/scenes/elasticity_scenes.h"

namespace bullet_fem
{

/// A law with its default constants, at E 1 MPa, as an element has it.
class LawCase
{
public:
    explicit LawCase(ElasticLaw law, double nu = 0.3) : m_law(lawOf(law))
    {
        for (std::size_t k = 0; k < m_law.m_constants.size(); ++k) m_constants[k] = m_law.m_constants[k].m_default;
        const LameModuli moduli = law == ElasticLaw::orthotropic ? Orthotropic().isotropicPart()
                                                                 : m_law.m_moduli(m_constants.data(), 1e6, nu);
        m_point.m_lambda = moduli.m_lambda;
        m_point.m_mu = moduli.m_mu;
        m_point.m_size = 0.1;
        m_point.m_constants = m_constants.data();
        m_point.m_history = m_history.data();
        m_point.m_stiffness = &m_stiffness;
    }
    LawCase(const LawCase&) = delete;
    LawCase& operator=(const LawCase&) = delete;

    LawResponse respond(const Mat3& e) const { return m_law.m_respond(e, m_point); }
    void advance(const Mat3& e) { m_law.m_advance(e, m_point, m_history.data()); }

    const Law& m_law;
    std::array<double, kMaxLawConstants> m_constants = {}, m_history = {};
    ElasticMatrix m_stiffness = Orthotropic::transverselyIsotropic(4e6, 1e6, 0.3, 0.35, 5e5).stiffness();
    LawPoint m_point;
};

/// A symmetric matrix of entries up to `size`.
inline Mat3 randomStrain(RandomVectors& random, double size)
{
    const Vec3 diagonal = random.next(), others = random.next();
    return size *
           Mat3{{{diagonal.x, others.z, others.y}, {others.z, diagonal.y, others.x}, {others.y, others.x, diagonal.z}}};
}

}  // namespace bullet_fem

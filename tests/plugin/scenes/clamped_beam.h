// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include "plugin/scenes/soft_boxes.h"

namespace bullet_fem
{

/// A beam of 4 x 1 x 1 m along x, clamped at its lower end of x, under gravity.
class ClampedBeam
{
public:
    struct Settings
    {
        btScalar m_youngModulus = btScalar(1e6);  ///< [Pa]
        btScalar m_massDamping = 0;               ///< [1/s]
        btFemSolverInfo m_info;
    };

    explicit ClampedBeam(const Settings& settings) : m_fem(settings.m_info), m_world(m_fem)
    {
        SoftBox box;
        box.m_size = {4, 1, 1};
        box.m_cells = {12, 3, 3};
        m_body = makeSoftBox(m_world, m_fem, box);
        for (int i = 0; i < m_body->m_nodes.size(); ++i)
            if (m_body->m_nodes[i].m_x.x() < btScalar(-1.999)) m_body->setMass(i, 0);
        btFemMaterial material;
        material.m_youngModulus = settings.m_youngModulus;
        material.m_density = 1000;
        material.m_massDamping = settings.m_massDamping;
        m_fem.setMaterial(m_body, material);
        m_world.addSoft(m_body);
        for (int i = 0; i < m_body->m_nodes.size(); ++i)
            if (m_body->m_nodes[i].m_x.dot({1, 1, 1}) > m_body->m_nodes[m_tip].m_x.dot({1, 1, 1})) m_tip = i;
    }

    void step(int count = 1, btScalar h = kStep) { m_world.step(count, h); }
    btVector3 tip() const { return m_body->m_nodes[m_tip].m_x; }  ///< [m]
    const btFemStepReport& report() const { return m_fem.stepReport(m_body); }
    bool isFlagged(btFemFlags flag) const { return (report().m_flags & flag) != 0; }
    btFemSoftBodySolver& fem() { return m_fem; }
    SoftWorld& world() { return m_world; }
    btSoftBody& body() { return *m_body; }

private:
    btFemSoftBodySolver m_fem;
    SoftWorld m_world;
    btSoftBody* m_body;
    int m_tip = 0;
};

}  // namespace bullet_fem

// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "bullet_fem/fem/body_state.h"

namespace bullet_fem
{

BodyState::BodyState(const BodyModel& model)
    : m_x(model.mesh().restPositions()),
      m_v(m_x.size()),
      m_mass(model.factorInput().m_mass),
      m_fixed(model.factorInput().m_fixed),
      m_elementRotation(model.shape().m_elements.size(), Mat3::identity()),
      m_nodeRotation(m_x.size(), Mat3::identity())
{
}

}  // namespace bullet_fem

// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "bullet_fem/fem/step/body_state.h"

#include "fem/elements/model_elements.h"

namespace bullet_fem
{

BodyState::BodyState(const BodyModel& model)
    : m_x(model.mesh().restPositions()),
      m_v(m_x.size()),
      m_mass(model.factorInput().m_mass),
      m_fixed(model.factorInput().m_fixed),
      m_lastIncrement{m_v, m_v},
      m_elementRotation(static_cast<std::size_t>(kLanes) * model.elements().blockCount())
{
}

}  // namespace bullet_fem

// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "bullet_fem/fem/body/body_state.h"

#include "fem/elements/model_elements.h"

namespace bullet_fem
{

void BodyState::resizeHistoryVariables(const BodyModel& model)
{
    const ElementMaterials& materials = model.shape().m_materials;
    const std::size_t elements = model.mesh().tets().size();
    if (materials.yields() && m_plasticStrain.empty())
    {
        m_plasticStrain.resize(elements);
        m_equivalentPlasticStrain.resize(elements);
    }
    const std::size_t relaxed = elements * static_cast<std::size_t>(materials.relaxationTerms());
    if (m_relaxedStrain.size() != relaxed) m_relaxedStrain.assign(relaxed, SymmetricTensor());
    const std::size_t history = elements * static_cast<std::size_t>(materials.historyCount());
    if (m_lawHistory.size() != history) m_lawHistory.assign(history, 0.0);
}

BodyState::BodyState(const BodyModel& model)
    : m_x(model.mesh().restPositions()),
      m_v(m_x.size()),
      m_mass(model.factorInput().m_mass),
      m_fixed(model.factorInput().m_fixed),
      m_lastIncrement{m_v, m_v},
      m_elementRotation(static_cast<std::size_t>(kLanes) * model.elements().blockCount())
{
    resizeHistoryVariables(model);
}

}  // namespace bullet_fem

// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "bullet_fem/fem/body/body.h"

#include <algorithm>
#include <stdexcept>
#include <string>
#include <utility>

#include "fem/body/step_scratch.h"
#include "fem/elements/model_elements.h"
#include "fem/factor/rest_factor.h"

namespace bullet_fem
{

ElasticEnergyScratch::ElasticEnergyScratch(const RestShape& shape)
    : m_dilatation(shape.m_patches.count()), m_strain(shape.m_assumedStrain.empty() ? 0 : shape.m_elements.size())
{
    for (const RestElement& element : shape.m_elements) m_stiffness += 2 * element.m_muVolume + element.m_lambdaVolume;
}

StepScratch::StepScratch(const BodyModel& model)
    : m_velocity(model.nodeCount()),
      m_kickPosition(model.nodeCount()),
      m_kickVelocity(model.nodeCount()),
      m_drift(model.nodeCount()),
      m_meanVelocity(model.nodeCount()),
      m_push(model.nodeCount()),
      m_strained(model.nodeCount()),
      m_rightSide(model.nodeCount()),
      m_increment(model.nodeCount()),
      m_impulses(model.nodeCount()),
      m_residual(model.nodeCount()),
      m_momentum(model.mesh()),
      m_led(model.mesh()),
      m_solver(model.nodeCount()),
      m_newton(model.shape().m_materials.isNonlinear() ? static_cast<std::size_t>(model.nodeCount()) : 0),
      m_elasticEnergy(model.shape()),
      m_reactions(model),
      m_elements(model.nodeCount(), model.elements().blockCount()),
      m_factor{allocateFloats(model.factor().lower().vectorSize()),
               allocateFloats(model.factor().lower().scratchSize()),
               std::vector<RestModes::Motion>(2 * model.restModes().components().size())}
{
}

Workspace::Workspace(const BodyModel& model) : m_scratch(std::make_unique<StepScratch>(model)) {}
Workspace::~Workspace() = default;
Workspace::Workspace(Workspace&&) noexcept = default;
Workspace& Workspace::operator=(Workspace&&) noexcept = default;

void Body::setModel(std::shared_ptr<const BodyModel> model)
{
    if (!model || model->nodeCount() != m_model->nodeCount() || model->mesh().tets() != m_model->mesh().tets())
        throw std::invalid_argument("Body::setModel: the new model has another mesh; make a new body for it");
    const ElementLanes &before = m_model->elements().m_lanes, &after = model->elements().m_lanes;
    if (before.m_element != after.m_element)  // differs if only one of them has patches
    {
        std::vector<Quaternion> rotation;
        for (const int e : after.m_element) rotation.push_back(m_state.m_elementRotation[before.m_lane[e]]);
        m_state.m_elementRotation = std::move(rotation);
    }
    m_state.resizeHistoryVariables(*model);
    m_workspace = Workspace(*model);
    m_model = std::move(model);
}

}  // namespace bullet_fem

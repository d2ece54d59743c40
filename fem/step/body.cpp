// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "bullet_fem/fem/step/body.h"

#include <algorithm>
#include <stdexcept>
#include <string>
#include <utility>

#include "fem/elements/model_elements.h"
#include "fem/factor/rest_factor.h"
#include "fem/step/step_scratch.h"

namespace bullet_fem
{

StepScratch::StepScratch(const BodyModel& model)
    : m_velocity(model.nodeCount()),
      m_kickPosition(model.nodeCount()),
      m_drift(model.nodeCount()),
      m_meanVelocity(model.nodeCount()),
      m_push(model.nodeCount()),
      m_strained(model.nodeCount()),
      m_rightSide(model.nodeCount()),
      m_increment(model.nodeCount()),
      m_residual(model.nodeCount()),
      m_momentum(model.mesh()),
      m_solver(model.nodeCount()),
      m_elements(model.nodeCount(), model.elements().blockCount()),
      m_factor{allocateFloats(model.factor().lower().vectorSize()),
               allocateFloats(model.factor().lower().scratchSize())}
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
    m_workspace = Workspace(*model);
    m_model = std::move(model);
}

}  // namespace bullet_fem

// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <memory>

#include "bullet_fem/fem/step/body_state.h"
#include "bullet_fem/fem/step/step_types.h"

namespace bullet_fem
{

struct StepScratch;

/// The vectors that one body's step works in. Sized once for a mesh and a factor; a step never allocates.
class Workspace
{
public:
    explicit Workspace(const BodyModel& model);
    ~Workspace();
    Workspace(Workspace&&) noexcept;
    Workspace& operator=(Workspace&&) noexcept;

    StepScratch& scratch() { return *m_scratch; }
    const StepScratch& scratch() const { return *m_scratch; }

private:
    std::unique_ptr<StepScratch> m_scratch;
};

/// A deformable body: the const model that it may share, its state, what acts on it, and its scratch.
struct Body
{
    explicit Body(std::shared_ptr<const BodyModel> model)
        : m_model(std::move(model)), m_state(*m_model), m_loads(m_model->nodeCount()), m_workspace(*m_model)
    {
    }

    /// Exchanges the factor (a new step, mass or set of fixed nodes) and keeps the motion. The mesh must be the same;
    /// throws std::invalid_argument otherwise. Allocates.
    void setModel(std::shared_ptr<const BodyModel> model);

    std::shared_ptr<const BodyModel> m_model;
    BodyState m_state;
    StepLoads m_loads;
    Workspace m_workspace;
};

}  // namespace bullet_fem

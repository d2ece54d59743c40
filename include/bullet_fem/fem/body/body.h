// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <memory>

#include "bullet_fem/fem/body/actuators.h"
#include "bullet_fem/fem/body/body_state.h"
#include "bullet_fem/fem/body/step_types.h"
#include "bullet_fem/fem/common/export.h"

namespace bullet_fem
{

struct StepScratch;

/// The vectors that one body's step works in. Sized once for a mesh and a factor; a step never allocates.
class BULLETFEM_API Workspace
{
public:
    /// For bodies of this model. Allocates.
    explicit Workspace(const BodyModel& model);
    ~Workspace();
    /// Moves: the other is not to be used then.
    Workspace(Workspace&&) noexcept;
    /// Likewise.
    Workspace& operator=(Workspace&&) noexcept;

    /// What the step works in; its type is not public.
    StepScratch& scratch() { return *m_scratch; }
    /// The same, to read.
    const StepScratch& scratch() const { return *m_scratch; }

private:
    std::unique_ptr<StepScratch> m_scratch;
};

/// A deformable body: the const model that it may share, its state, what acts on it, and its scratch.
struct BULLETFEM_API Body
{
    /// At rest in the rest shape. `model` is not null. Allocates.
    explicit Body(std::shared_ptr<const BodyModel> model)
        : m_model(std::move(model)), m_state(*m_model), m_loads(m_model->nodeCount()), m_workspace(*m_model)
    {
    }

    /// Exchanges the factor (a new step, mass or set of fixed nodes) and keeps the motion. The mesh must be the same;
    /// throws std::invalid_argument otherwise. Allocates.
    void setModel(std::shared_ptr<const BodyModel> model);

    /// Mesh, material and factor; not null.
    std::shared_ptr<const BodyModel> m_model;
    /// Positions, velocities, masses and pins.
    BodyState m_state;
    /// What acts on the body in the next step.
    StepLoads m_loads;
    Actuators m_actuators;  ///< validated by who adds them; not to be changed within a step
    /// Scratch of its steps.
    Workspace m_workspace;
};

}  // namespace bullet_fem

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

/// Scratch vectors of one body's steps. Sized once for a mesh and a factor; a step never allocates.
class BULLETFEM_API Workspace
{
public:
    /// Scratch for bodies of this model. Allocates.
    explicit Workspace(const BodyModel& model);
    ~Workspace();
    /// Moves; the source must not be used afterwards.
    Workspace(Workspace&&) noexcept;
    /// Moves; the source must not be used afterwards.
    Workspace& operator=(Workspace&&) noexcept;

    /// The scratch data; the type is internal.
    StepScratch& scratch() { return *m_scratch; }
    /// The scratch data, read-only; the type is internal.
    const StepScratch& scratch() const { return *m_scratch; }

private:
    std::unique_ptr<StepScratch> m_scratch;
};

/// A deformable body: its model, which it may share, its state, its loads and its scratch memory.
struct BULLETFEM_API Body
{
    /// A body at rest in the rest shape. `model` is not null. Allocates.
    explicit Body(std::shared_ptr<const BodyModel> model)
        : m_model(std::move(model)), m_state(*m_model), m_loads(m_model->nodeCount()), m_workspace(*m_model)
    {
    }

    /// Replaces the model (another step, mass, set of fixed nodes or material) and keeps the motion. Throws
    /// std::invalid_argument if the mesh differs. Allocates.
    void setModel(std::shared_ptr<const BodyModel> model);

    /// Mesh, material and factor; not null.
    std::shared_ptr<const BodyModel> m_model;
    /// Positions, velocities, masses and pins.
    BodyState m_state;
    /// Loads of the next step.
    StepLoads m_loads;
    Actuators m_actuators;  ///< validated by the caller that adds them; must not change during a step
    /// Scratch memory of the steps.
    Workspace m_workspace;
};

}  // namespace bullet_fem

// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// Decides which bodies are solved side by side.
#include <cstring>

#include "fem/batch/batch_arrays.h"
#include "fem/batch/batched_solve.h"
#include "fem/body/internal_stress.h"
#include "fem/body/step_coefficients.h"
#include "fem/body/step_scratch.h"
#include "fem/solve/warped_system.h"

namespace bullet_fem
{
namespace
{

bool isPlain(const Body& body, const StepSettings& settings)
{
    const std::vector<unsigned char>& fixed = body.m_state.m_fixed;
    return settings.m_batchMemory && settings.m_warp == Warp::nodal && isSinglePrecision(settings) &&
           !body.m_model->shape().m_materials.isNonlinear() && !(body.m_loads.m_frameDamping > 0) &&
           !hasInitialStress(body) && !body.m_actuators.hasPulls() &&
           (StepCoefficients(settings, body).m_damping == 1 || body.m_loads.m_priorVelocity.empty()) &&
           !std::memchr(fixed.data(), 1, fixed.size()) && canBeBatched(*body.m_model);
}

template <class Job>
bool areJobsEqual(const Job& jobA, const Job& jobB)
{
    const StepSettings &a = jobA.m_settings, &b = jobB.m_settings;
    return StepCoefficients(a, *jobA.m_body).m_damping == StepCoefficients(b, *jobB.m_body).m_damping &&
           a.m_step == b.m_step && a.m_tension == b.m_tension && a.m_batchMemory == b.m_batchMemory;
}

}  // namespace

bool canBeBatched(const FreeMotion& motion)
{
    return isPlain(*motion.m_body, motion.m_settings) && motion.m_body->m_loads.m_priorVelocity.empty();
}

bool canBeBatched(const ImpulseResponse& response)
{
    return isPlain(*response.m_body, response.m_settings) &&
           !response.m_body->m_workspace.scratch().m_elements.m_isDouble;
}

bool canBeBatched(const StepEnd& end)
{
    return end.m_needsSmoothing && isPlain(*end.m_body, end.m_settings) &&
           !end.m_body->m_workspace.scratch().m_elements.m_isDouble;
}

bool areEqual(const FreeMotion& a, const FreeMotion& b)
{
    const StepScratch &scratchA = a.m_body->m_workspace.scratch(), &scratchB = b.m_body->m_workspace.scratch();
    return areJobsEqual(a, b) && scratchA.m_stepVariation == scratchB.m_stepVariation &&
           scratchA.m_isTurned == scratchB.m_isTurned &&
           a.m_body->m_loads.m_isInContact == b.m_body->m_loads.m_isInContact;
}
bool areEqual(const ImpulseResponse& a, const ImpulseResponse& b)
{
    return areJobsEqual(a, b);
}
bool areEqual(const StepEnd& a, const StepEnd& b)
{
    return areJobsEqual(a, b);
}

}  // namespace bullet_fem

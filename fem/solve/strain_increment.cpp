// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "fem/solve/strain_increment.h"

#include <algorithm>
#include <cmath>

#include "bullet_fem/fem/common/threads.h"
#include "fem/body/step_coefficients.h"
#include "fem/body/step_scratch.h"
#include "fem/common/chunks.h"
#include "fem/elements/model_elements.h"

namespace bullet_fem
{
namespace
{

// True if the element's strain increment exceeds `gentle`, or gentle times det F in compressed elements: with L = G
// F^-1, G the displacement gradient of the path, the measure is the norm of (sym(L) + L^T L / 2) F, the change of
// Green's strain in the present shape times F. It is zero for rotations.
bool isStrained(const Body& body, int e, double time, const std::vector<Vec3>& v, const std::vector<Vec3>* dv,
                double gentle)
{
    const Tet& tet = body.m_model->mesh().tets()[e];
    const Mat3& DmInverse = body.m_model->shape().m_elements[e].m_DmInverse;
    const std::vector<Vec3>& x = body.m_state.m_x;
    const auto edge = [&tet](const std::vector<Vec3>& u, int a) { return u[tet[a]] - u[tet[0]]; };
    const auto change = [&](int a) { return dv ? edge(v, a) + edge(*dv, a) : edge(v, a); };
    const Mat3 F = Mat3::fromColumns(edge(x, 1), edge(x, 2), edge(x, 3)) * DmInverse;
    const double most = gentle * std::min(1.0, determinant(F));
    if (!(most > 0)) return true;
    const Mat3 G = time * (Mat3::fromColumns(change(1), change(2), change(3)) * DmInverse);
    const Mat3 L = G * inverse(F);
    const Mat3 strain = 0.5 * (L + transpose(L) + transpose(L) * L) * F;
    return !(squaredNorm(strain) <= most * most);
}

double fastest(const std::vector<Vec3>& v, const Vec3& rigid)
{
    double most = 0;
    for (const Vec3& vi : v) most = std::max(most, dot(vi - rigid, vi - rigid));
    return std::sqrt(most);
}

}  // namespace

bool exceedsStrainIncrement(const Body& body, double time, const std::vector<Vec3>& v, const std::vector<Vec3>* dv,
                            double gentle, const Threads* threads)
{
    const Chunks chunks(body.m_model->mesh().tetCount(), kEntriesPerChunk);
    bool isAny[Chunks::kMax] = {};
    runTasks(threads, chunks.count(),
             [&](int k)
             {
                 for (int e = chunks[k].m_begin; e < chunks[k].m_end && !isAny[k]; ++e)
                     isAny[k] = isStrained(body, e, time, v, dv, gentle);
             });
    return std::any_of(isAny, isAny + chunks.count(), [](bool is) { return is; });
}

void chooseDamping(Body& body, const StepSettings& settings)
{
    StepScratch& scratch = body.m_workspace.scratch();
    scratch.m_leastDamping = 0;
    const double before = (1 - StepCoefficients(settings, body).theta()) * settings.m_step;
    if (!(before > 0)) return;
    const BodyState& state = body.m_state;
    std::vector<Vec3>& v = scratch.m_increment;
    for (std::size_t i = 0; i < v.size(); ++i)
        v[i] = state.m_fixed[i] ? body.m_loads.m_targetVelocity[i] : state.m_v[i];
    const bool isLinear = !body.m_model->shape().m_materials.isNonlinear();
    const double gentle = isLinear ? kMaxStrainIncrementOfHooke : kMaxStrainIncrement;
    // Upper bound of the strain increment of elements near their rest shape: relative displacement over the minimum
    // height.
    const auto isGentle = [&](const Vec3& rigid)
    {
        const double strain = 2 * before * fastest(v, rigid) / body.m_model->mesh().shortestHeight();
        return isLinear && strain < gentle;
    };
    if (isGentle(v[0])) return;
    scratch.m_momentum.removeMomentum(body, settings.m_step, state.m_x, v);  // removes its rigid motion
    if (isGentle({})) return;
    if (exceedsStrainIncrement(body, before, v, nullptr, gentle, settings.m_threads)) scratch.m_leastDamping = 1;
}

}  // namespace bullet_fem

// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "plugin/policy/btFemRefactorPolicy.h"

#include <exception>
#include <limits>
#include <memory>
#include <utility>

#include "bullet_bridge/node_exchange.h"
#include "plugin/bodies/btFemBodyRegistry.h"

using namespace bullet_fem;

namespace
{

constexpr double kSameFactor =
    1 + 2e-3;  // ratio of step or mass up to which a factor is not called stale: a copy elsewhere may share it

double priceFor(const btFemEntry& entry)
{
    return refactorPrice(*entry.m_fem->m_body.m_model);
}

}  // namespace

double staleness(const btFemEntry& entry, double step)
{
    const Body& body = entry.m_fem->m_body;
    if (body.m_model->factorInput().m_fixed != body.m_state.m_fixed) return std::numeric_limits<double>::infinity();
    const double mismatch = factorMismatch(*entry.m_fem, step);
    return mismatch > kSameFactor ? mismatch : 1;
}

void btFemRefactorPolicy::note(btFemEntry& entry, int iterations, double staleness) const
{
    entry.m_factorAccount.note(iterations, staleness, m_tolerance);
    if (entry.m_factorAccount.refactorPays(priceFor(entry))) entry.m_report.m_flags |= BT_FEM_REFACTOR_PAYS;
}

void btFemRefactorPolicy::refresh(btFemBodyRegistry& registry, btFemEntry& entry, double step)
{
    if (m_refactoring == btFemRefactoring::onRequest) return;
    if (entry.m_factorJob) return takeOver(registry, entry, step);
    if (!entry.m_factorAccount.refactorPays(priceFor(entry)) || staleness(entry, step) <= 1) return;
    if (m_refactoring == btFemRefactoring::background && !registry.knowsFactor(entry, step))
        return startJob(registry, entry, step);
    entry.m_factorAccount.spend(priceFor(entry));
    registry.tryRefactor(entry, step);
}

void btFemRefactorPolicy::startJob(const btFemBodyRegistry& registry, btFemEntry& entry, double step)
{
    try
    {
        entry.m_factorJob =
            m_thread.start(entry.m_fem->m_body.m_model->sharedShape(), registry.factorInput(entry, step));
    }
    catch (const std::exception& error)  // no thread to be had
    {
        entry.m_message = error.what();
        entry.m_factorAccount.spend(priceFor(entry));
    }
}

void btFemRefactorPolicy::takeOver(btFemBodyRegistry& registry, btFemEntry& entry, double step) const
{
    if (!entry.m_factorJob->m_done.load(std::memory_order_acquire)) return;
    const std::shared_ptr<btFemFactorJob> job = std::move(entry.m_factorJob);
    entry.m_factorAccount.spend(priceFor(entry));
    if (!job->m_model) entry.m_message = job->m_error;
    // Of no use after all if what was changed was changed back. (Another material drops the job.)
    if (job->m_model && staleness(entry, step) > 1) registry.takeFactor(entry, job->m_model);
}

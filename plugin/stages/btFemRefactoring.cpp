// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "plugin/stages/btFemRefactoring.h"

#include <exception>
#include <memory>
#include <utility>

#include "fem/common/reason.h"
#include "plugin/setup/btFemBodySetUp.h"

using namespace bullet_fem;

namespace
{

// Largest ratio between the factor's step or masses and the present ones in contact or with joints; beyond it the body
// is refactored, as with other pins that have cost as much. Otherwise a stale factor only costs iterations, but
// contacts and joints would use a wrong compliance.
constexpr double kRefactorInContact = 1.5;

// True if the body had contacts or joints in the last step, or has joints now.
bool meetsOthers(const btFemBodyRecord& record)
{
    const btSoftBody& soft = *record.m_softBody;
    const HeldJoints& joints = record.fem().m_joints;
    return record.m_reports.m_contacts.size() > 0 || record.m_reports.m_anchors.size() > 0 ||
           soft.m_anchors.size() > 0 || soft.m_deformableAnchors.size() > 0 || soft.m_joints.size() > 0 ||
           !joints.m_attachments.empty() || !joints.m_springs.empty() || !joints.m_welds.empty();
}

double priceFor(const btFemBodyRecord& record)
{
    return refactorPrice(*record.fem().m_body.m_model);
}

}  // namespace

void btFemRefactorPolicy::note(btFemBodyRecord& record, int iterations) const
{
    record.m_work.m_factorAccount.note(iterations, record.m_work.m_staleness, m_tolerance);
    if (record.m_work.m_factorAccount.refactorPays(priceFor(record)))
        record.m_reports.m_step.m_flags |= BT_FEM_REFACTOR_PAYS;
}

void btFemRefactorPolicy::refresh(btFemBodySetUp& setUp, btFemBodyRecord& record, double step)
{
    if (m_refactoring == btFemRefactoring::onRequest) return;
    if (record.m_work.m_factorJob) return takeOver(setUp, record, step);
    if (!record.m_work.m_factorAccount.refactorPays(priceFor(record)) || staleness(record, step) <= 1) return;
    if (m_refactoring == btFemRefactoring::background && !setUp.knowsFactor(record, step))
        return startJob(setUp, record, step);
    record.m_work.m_factorAccount.spend(priceFor(record));
    setUp.tryRefactor(record, step);
}

void btFemRefactorPolicy::startJob(const btFemBodySetUp& setUp, btFemBodyRecord& record, double step)
{
    try
    {
        record.m_work.m_factorJob =
            m_thread.start(record.fem().m_body.m_model->sharedShape(), setUp.factorInput(record, step));
    }
    catch (const std::exception& error)  // no thread is available
    {
        record.m_model.m_message = reasonOf(error);
        record.m_work.m_factorAccount.spend(priceFor(record));
    }
}

void btFemRefactorPolicy::takeOver(btFemBodySetUp& setUp, btFemBodyRecord& record, double step) const
{
    if (!record.m_work.m_factorJob->m_done.load(std::memory_order_acquire)) return;
    const std::shared_ptr<btFemFactorJob> job = std::move(record.m_work.m_factorJob);
    record.m_work.m_factorAccount.spend(priceFor(record));
    if (!job->m_model) record.m_model.m_message = job->m_error;
    // Useless if the change was undone meanwhile. (A new material drops the job.)
    if (job->m_model && staleness(record, step) > 1) setUp.takeFactor(record, job->m_model);
}

void btFemRefactorPolicy::renew(btFemBodySetUp& setUp, btFemBodyRecord& record, double step)
{
    btFemFactorAccount& account = record.m_work.m_factorAccount;
    const FemSoftBody& fem = record.fem();
    const bool hasOtherPins = fem.m_body.m_model->factorInput().m_fixed != fem.m_body.m_state.m_fixed;
    if (hasOtherPins) account.noteContact(record.m_reports.m_step.m_contactIterations);
    const bool isFarOff = record.m_work.m_factorMismatch > kRefactorInContact;
    const bool pays = hasOtherPins && account.refactorPays(priceFor(record));
    if (!(isFarOff || pays) || !meetsOthers(record)) return refresh(setUp, record, step);
    setUp.tryRefactor(record, step);
    isFarOff ? account.clear() : account.spend(priceFor(record));
}

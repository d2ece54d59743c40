// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include <string>

#include "bullet_fem/btFemSolverInfo.h"
#include "bullet_fem/fem/common/threads.h"
#include "plugin/record/btFemRangeCheck.h"

using namespace bullet_fem;

bool btFemSolverInfo::valid(std::string* why) const
{
    return btFemRangeCheck(m_tolerance >= btScalar(1e-8) && m_tolerance <= btScalar(0.5), why, "m_tolerance",
                           m_tolerance, "[1e-8, 0.5]; 1e-3 is usual") &&
           btFemRangeCheck(m_numericalDamping >= 0 && m_numericalDamping <= 1, why, "m_numericalDamping",
                           m_numericalDamping, "[0, 1]; 0 is usual") &&
           btFemRangeCheck(m_contactDamping >= 0 && m_contactDamping <= 1, why, "m_contactDamping", m_contactDamping,
                           "[0, 1]; 1 is usual") &&
           btFemRangeCheck(m_maxIterations >= 1 && m_maxIterations <= 10000, why, "m_maxIterations", m_maxIterations,
                           "[1, 10000]; 100 is usual") &&
           btFemRangeCheck(m_contactRounds >= 1 && m_contactRounds <= 10, why, "m_contactRounds", m_contactRounds,
                           "[1, 10]; 1 is usual") &&
           btFemRangeCheck(m_contactSweeps >= 1 && m_contactSweeps <= 1000, why, "m_contactSweeps", m_contactSweeps,
                           "[1, 1000]; 50 is usual") &&
           btFemRangeCheck(m_contactTolerance >= btScalar(1e-7) && m_contactTolerance <= btScalar(0.1), why,
                           "m_contactTolerance", m_contactTolerance, "[1e-7, 0.1]; 3e-3 is usual") &&
           btFemRangeCheck(m_maxContacts >= 8 && m_maxContacts <= 20000, why, "m_maxContacts", m_maxContacts,
                           "[8, 20000]; 2000 is usual") &&
           btFemRangeCheck(m_erp >= 0 && m_erp <= 1, why, "m_erp", m_erp, "[0, 1]; 0.2 is usual") &&
           btFemRangeCheck(m_maxPushVelocity >= 0 && m_maxPushVelocity <= 1000, why, "m_maxPushVelocity",
                           m_maxPushVelocity, "[0, 1000] m/s; 1 is usual") &&
           btFemRangeCheck(m_maxFactorMegabytes >= 0 && m_maxFactorMegabytes <= btScalar(1e6), why,
                           "m_maxFactorMegabytes", m_maxFactorMegabytes,
                           "[0, 1e6] MB; 0, which is no limit, is usual") &&
           btFemRangeCheck(m_factorChoice >= btFemFactorChoice::full && m_factorChoice <= btFemFactorChoice::lowMemory,
                           why, "m_factorChoice", static_cast<int>(m_factorChoice),
                           "[full, lowMemory], 0 to 2; full is usual") &&
           btFemRangeCheck(m_threads >= 0 && m_threads <= Threads::kMax, why, "m_threads", m_threads,
                           "[0, 256]; 1 is usual, 0 takes all that the machine has") &&
           btFemRangeCheck(
               m_refactoring >= btFemRefactoring::onRequest && m_refactoring <= btFemRefactoring::background, why,
               "m_refactoring", static_cast<int>(m_refactoring), "btFemRefactoring; onRequest is usual");
}

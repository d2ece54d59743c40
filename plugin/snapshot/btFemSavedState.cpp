// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include <string>

#include "bullet_fem/btFemSoftBodySolver.h"
#include "plugin/dispatch/btFemManifolds.h"
#include "plugin/record/btFemCoupling.h"
#include "plugin/snapshot/btFemDefinition.h"
#include "plugin/snapshot/btFemEnvelope.h"
#include "plugin/snapshot/btFemSnapshot.h"

using namespace bullet_fem;

bool btFemSoftBodySolver::saveState(std::vector<unsigned char>& buffer, std::string* why) const
{
    const bool saved = attemptAs("saveState", why, [&] { saveSnapshot(btFemCoupling::snapshotScope(*this), buffer); });
    if (!saved) buffer.clear();
    return saved;
}

bool btFemSoftBodySolver::restoreState(const unsigned char* data, std::size_t size, std::string* why)
{
    const bool restored =
        attemptAs("restoreState", why, [&] { checkedSnapshot(btFemCoupling::snapshotScope(*this), data, size)(); });
    const auto manifolds = btFemCoupling::manifolds(*this);
    if (restored && manifolds) manifolds->update();
    return restored;
}

bool btFemSoftBodySolver::saveDefinition(const btSoftBody* body, std::vector<unsigned char>& buffer,
                                         std::string* why) const
{
    const bool saved =
        attemptAs("saveDefinition", why, [&] { ::saveDefinition(btFemCoupling::registry(*this), body, buffer); });
    if (!saved) buffer.clear();
    return saved;
}

bool btFemSoftBodySolver::applyDefinition(btSoftBody* body, const unsigned char* data, std::size_t size,
                                          std::string* why)
{
    return attemptAs("applyDefinition", why,
                     [&] { ::applyDefinition(btFemCoupling::registry(*this), body, data, size); });
}

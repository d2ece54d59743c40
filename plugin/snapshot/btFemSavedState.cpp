// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include <string>

#include "bullet_fem/btFemSoftBodySolver.h"
#include "fem/common/message.h"
#include "plugin/bodies/btFemDefinition.h"
#include "plugin/btFemAttempt.h"
#include "plugin/btFemCoupling.h"
#include "plugin/contact/btFemManifolds.h"

using namespace bullet_fem;

namespace
{

// Says who refused.
template <class Call>
void named(const char* name, const Call& call)
{
    std::string why;
    if (!succeeds(call, &why)) reject(name, ": ", why);
}

}  // namespace

void btFemSoftBodySolver::saveState(std::vector<unsigned char>& buffer) const
{
    named("saveState", [&] { saveSnapshot(btFemCoupling::snapshotScope(*this), buffer); });
}

bool btFemSoftBodySolver::saveState(std::vector<unsigned char>& buffer, std::string* why) const
{
    const bool saved = succeeds([&] { saveState(buffer); }, why);
    if (!saved) buffer.clear();
    return saved;
}

void btFemSoftBodySolver::restoreState(const unsigned char* data, std::size_t size)
{
    named("restoreState", [&] { restoreSnapshot(btFemCoupling::snapshotScope(*this), data, size); });
    if (const auto manifolds = btFemCoupling::manifolds(*this)) manifolds->update();
}

bool btFemSoftBodySolver::restoreState(const unsigned char* data, std::size_t size, std::string* why)
{
    return succeeds([&] { restoreState(data, size); }, why);
}

void btFemSoftBodySolver::saveDefinition(const btSoftBody* body, std::vector<unsigned char>& buffer) const
{
    named("saveDefinition", [&] { ::saveDefinition(btFemCoupling::snapshotScope(*this).m_registry, body, buffer); });
}

bool btFemSoftBodySolver::saveDefinition(const btSoftBody* body, std::vector<unsigned char>& buffer,
                                         std::string* why) const
{
    const bool saved = succeeds([&] { saveDefinition(body, buffer); }, why);
    if (!saved) buffer.clear();
    return saved;
}

void btFemSoftBodySolver::applyDefinition(btSoftBody* body, const unsigned char* data, std::size_t size)
{
    named("applyDefinition",
          [&] { ::applyDefinition(btFemCoupling::snapshotScope(*this).m_registry, body, data, size); });
}

bool btFemSoftBodySolver::applyDefinition(btSoftBody* body, const unsigned char* data, std::size_t size,
                                          std::string* why)
{
    return succeeds([&] { applyDefinition(body, data, size); }, why);
}

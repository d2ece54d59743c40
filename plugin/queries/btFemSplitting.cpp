// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "bullet_fem/btFemFracture.h"

#include <stdexcept>

#include "BulletSoftBody/btSoftBody.h"
#include "bullet_fem/btFemSoftBodySolver.h"
#include "fem/common/attempt.h"
#include "plugin/record/btFemBodyRecord.h"
#include "plugin/record/btFemCoupling.h"
#include "plugin/record/btFemRangeCheck.h"
#include "plugin/registry/btFemBodyRegistry.h"
#include "plugin/stages/btFemSplitter.h"

using namespace bullet_fem;

namespace
{

constexpr double kLargestTension = 1e13;  // [Pa]; as of initial stresses
constexpr int kMaxCracks = 1000;

}  // namespace

bool btFemTensileStrength::valid(std::string* why) const
{
    return btFemRangeCheck(m_tension > 0 && m_tension <= kLargestTension, why, "m_tension", m_tension,
                           "(0, 1e13] Pa; for a body that does not split call clearStrength()") &&
           btFemRangeCheck(m_mostCracks >= 1 && m_mostCracks <= kMaxCracks, why, "m_mostCracks", m_mostCracks,
                           "[1, 1000]; take 1 for what tears and more for what shatters");
}

bool btFemFracture::setStrength(btFemSoftBodySolver& solver, btSoftBody* body, const btFemTensileStrength& strength,
                                std::string* why)
{
    const auto set = [&]
    {
        std::string reason;
        if (!strength.valid(&reason)) throw std::invalid_argument("setStrength: " + reason);
        btFemBodyRecord& record = btFemCoupling::femRecord(solver, body, "setStrength");
        if (body->m_renderNodes.size() > 0)
            throw std::invalid_argument(
                "setStrength: the body has an embedded surface, which does not split; take a body without, or cut it "
                "into pieces and weld these (btFemWelds.h)");
        record.m_asked.m_strength = strength;
        record.m_model.m_flags &= ~BT_FEM_NOT_SPLIT;
    };
    return attempt(why, set);
}

void btFemFracture::clearStrength(btFemSoftBodySolver& solver, btSoftBody* body)
{
    btFemBodyRecord* record = btFemCoupling::registry(solver).find(body);
    if (record) record->m_asked.m_strength = {};
}

const btAlignedObjectArray<btFemSplit>& btFemFracture::splits(const btFemSoftBodySolver& solver)
{
    return btFemCoupling::splitter(solver).splits();
}

void btFemFracture::clearSplits(btFemSoftBodySolver& solver)
{
    btFemCoupling::splitter(solver).clearSplits();
}

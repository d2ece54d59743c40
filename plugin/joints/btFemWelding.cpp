// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "bullet_fem/btFemWelds.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "BulletSoftBody/btSoftBody.h"
#include "bullet_bridge/joints/welds.h"
#include "bullet_fem/btFemSoftBodySolver.h"
#include "bullet_fem/btFemVectors.h"
#include "fem/common/attempt.h"
#include "fem/common/message.h"
#include "plugin/joints/btFemWeldBreaker.h"
#include "plugin/record/btFemBodyRecord.h"
#include "plugin/record/btFemCoupling.h"
#include "plugin/record/btFemRangeCheck.h"

using namespace bullet_fem;

namespace
{

constexpr double kReach = 1e-3;         // largest distance of matching corners, over the shorter mean edge
constexpr double kFarthestReach = 1e3;  // [m]

bool areWelded(const FemSoftBody& a, const FemSoftBody& b)
{
    const auto joins = [](const FemSoftBody& from, const FemSoftBody& to)
    {
        const std::vector<Weld>& welds = from.m_joints.m_welds;
        return std::any_of(welds.begin(), welds.end(),
                           [&to](const Weld& weld) { return weld.m_other == to.m_softBody; });
    };
    return joins(a, b) || joins(b, a);
}

void checkStrength(const btFemWeldStrength& strength)
{
    std::string why;
    if (!strength.valid(&why)) throw std::invalid_argument("weld: " + why);
}

double reachOf(const FemSoftBody& a, const FemSoftBody& b)
{
    return kReach * std::min(a.m_body.m_model->mesh().meanEdgeLength(), b.m_body.m_model->mesh().meanEdgeLength());
}

int weldFaces(btFemWeldBreaker& breaker, FemSoftBody& a, const FemSoftBody& b, const CommonFaces& faces,
              const btFemWeldStrength& strength)
{
    Weld weld;
    weld.m_breakForce = strength.m_breakForce;
    weld.m_breakStress = strength.m_breakStress;
    weld.m_breakStretch = strength.m_breakStretch;
    breaker.makeRoom(static_cast<int>(faces.m_nodes.size()));
    return addWeld(a, b, faces, std::move(weld), strength.m_compliance);
}

}  // namespace

bool btFemWeldStrength::valid(std::string* why) const
{
    return btFemRangeCheck(m_breakForce > 0, why, "m_breakForce", m_breakForce,
                           "(0, inf] N; infinity for a weld that no force breaks") &&
           btFemRangeCheck(m_breakStress > 0, why, "m_breakStress", m_breakStress,
                           "(0, inf] Pa; infinity for a weld that no stress tears") &&
           btFemRangeCheck(m_breakStretch > 0, why, "m_breakStretch", m_breakStretch,
                           "(0, inf] m; infinity for a weld that no stretch tears") &&
           btFemRangeCheck(m_compliance >= 0 && m_compliance <= 1, why, "m_compliance", m_compliance,
                           "[0, 1] m/Pa; the thickness of the glue over its Young's modulus, or 0");
}

int btFemWelds::weld(btFemSoftBodySolver& solver, btSoftBody* a, btSoftBody* b, const btFemWeldStrength& strength,
                     btScalar reach, std::string* why)
{
    const auto weldBodies = [&]
    {
        checkStrength(strength);
        FemSoftBody &first = btFemCoupling::femRecord(solver, a, "weld").fem(),
                    &other = btFemCoupling::femRecord(solver, b, "weld").fem();
        if (a == b) throw std::invalid_argument("weld: a body cannot be welded to itself; give two bodies");
        if (!(reach >= 0 && reach <= kFarthestReach))
            reject("weld: the reach is ", reach, " m, not in [0, 1e3]; 0 takes a thousandth of a mean edge");
        if (areWelded(first, other)) throw std::invalid_argument("weld: the bodies are welded already; detach() first");
        const double within = reach > 0 ? double(reach) : reachOf(first, other);
        const CommonFaces faces = commonFaces(first, other, within);
        if (faces.m_faces.empty())
            reject("weld: the bodies have no face in common within ", within,
                   " m; cut them from one body, mesh them alike, or give a longer reach");
        return weldFaces(btFemCoupling::welds(solver), first, other, faces, strength);
    };
    return attemptValue(why, weldBodies);
}

int btFemWelds::weldPieces(btFemSoftBodySolver& solver, const std::vector<btFemPiece>& pieces,
                           const btFemWeldStrength& strength, std::string* why)
{
    const auto weldAll = [&]
    {
        checkStrength(strength);
        std::vector<FemSoftBody*> bodies;
        for (const btFemPiece& piece : pieces)
            bodies.push_back(&btFemCoupling::femRecord(solver, piece.m_body, "weldPieces").fem());
        int welded = 0;
        for (std::size_t a = 0; a < bodies.size(); ++a)
            for (std::size_t b = a + 1; b < bodies.size(); ++b)
            {
                if (bodies[a] == bodies[b]) throw std::invalid_argument("weldPieces: a body is given twice");
                if (areWelded(*bodies[a], *bodies[b]))
                    throw std::invalid_argument("weldPieces: two bodies are welded already; detach() first");
            }
        for (std::size_t a = 0; a < bodies.size(); ++a)
            for (std::size_t b = a + 1; b < bodies.size(); ++b)
            {
                const CommonFaces faces = commonFaces(*bodies[a], *bodies[b], reachOf(*bodies[a], *bodies[b]));
                if (faces.m_faces.empty()) continue;
                weldFaces(btFemCoupling::welds(solver), *bodies[a], *bodies[b], faces, strength);
                ++welded;
            }
        return welded;
    };
    return attemptValue(why, weldAll);
}

bool btFemWelds::welds(const btFemSoftBodySolver& solver, const btSoftBody* body,
                       btAlignedObjectArray<btFemWeldReport>& reports)
{
    reports.resize(0);
    const btFemBodyRecord* record = body ? btFemCoupling::record(solver, *body) : nullptr;
    if (!record || !record->isFem()) return false;
    WeldLoads& loads = btFemCoupling::welds(solver).loads();
    // without a step there are no impulses yet
    const double step = record->m_work.m_lastStep > 0 ? record->m_work.m_lastStep : 1;
    for (const Weld& weld : record->fem().m_joints.m_welds)
    {
        const WeldLoad& load = loads.load(record->fem(), weld, step);
        btFemWeldReport report;
        report.m_weld = weld.m_id;
        report.m_a = body;
        report.m_b = weld.m_other;
        report.m_nodes = load.m_nodes;
        report.m_area = static_cast<btScalar>(load.m_area);
        report.m_force = bulletVector(load.m_force);
        report.m_stress = static_cast<btScalar>(load.m_stress);
        report.m_stretch = static_cast<btScalar>(load.m_stretch);
        reports.push_back(report);
    }
    return true;
}

const btAlignedObjectArray<btFemWeldBreak>& btFemWelds::breaks(const btFemSoftBodySolver& solver)
{
    return btFemCoupling::welds(solver).breaks();
}

void btFemWelds::clearBreaks(btFemSoftBodySolver& solver)
{
    btFemCoupling::welds(solver).clearBreaks();
}

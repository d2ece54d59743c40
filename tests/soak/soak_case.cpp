// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "soak/soak_case.h"

#include <tuple>
#include <utility>

#include "bullet_fem/btFemVectors.h"
#include "fem/common/message.h"
#include "fem/common/reason.h"
#include "plugin/scenes/scene_measures.h"

namespace bullet_fem
{
namespace
{

// Ten times the initial speed: light bodies are hit by heavy ones.
constexpr double kFastest = 100;  // [m/s]
// Programs put bodies into others. A body of 1 GPa is crushed by position correction, and springs back.
constexpr double kFastestCrushed = 1000;  // [m/s]
constexpr int kTellsOfWork = BT_FEM_NOT_CONVERGED | BT_FEM_STALE_FACTOR | BT_FEM_SEVERAL_PIECES | BT_FEM_REFACTORED |
                             BT_FEM_LOST_ANCHOR | BT_FEM_REFACTOR_PAYS | BT_FEM_CONTACT_LIMIT | BT_FEM_SLIVERS |
                             BT_FEM_SOLVED_AFTER | BT_FEM_TOO_SOFT | BT_FEM_ENERGY;
constexpr int kTellsOfCrushing = BT_FEM_PENETRATING | BT_FEM_INSIDE_OUT;

// Inactive bodies keep values that the program wrote.
std::string faultOf(const btSoftBody& body)
{
    return allFinite(body) || !body.isActive() ? "" : "a node is not finite";
}

std::string faultOf(const btRigidBody& body)
{
    const bool finite =
        isFinite(vec3(body.getWorldTransform().getOrigin())) && isFinite(vec3(body.getLinearVelocity()));
    return finite ? "" : "a rigid body is not finite";
}

// A body put to sleep keeps its velocity, but not the flags that explain it.
std::string gentleFaultOf(const btFemSoftBodySolver& fem, const btSoftBody& body)
{
    if (!body.isActive()) return "";
    const int flags = fem.stepReport(&body).m_flags;
    if (flags & ~(kTellsOfWork | kTellsOfCrushing)) return message("flags 0x", std::hex, flags, " want a reason");
    const double fastest = fastestNode(body);
    if (fastest > (flags & kTellsOfCrushing ? kFastestCrushed : kFastest))
        return message("a node is as fast as ", fastest, " m/s");
    if (flags & kTellsOfCrushing) return "";
    if (flags & BT_FEM_CONTACT_LIMIT) return "";  // bodies without contacts sink into the floor
    if (massOf(body) > 0 && centerOf(body).z < 0) return message("its centre is at z = ", centerOf(body).z, " m");
    return "";
}

std::string faultOf(RandomProgram& program, Manner manner)
{
    for (std::size_t k = 0; k < program.soft().size(); ++k)
    {
        const btSoftBody& body = *program.soft()[k];
        std::string fault = faultOf(body);
        if (fault.empty() && manner == Manner::gentle) fault = gentleFaultOf(program.world().fem(), body);
        if (!fault.empty()) return message("soft body ", k, ": ", fault);
    }
    for (std::size_t k = 0; k < program.rigid().size(); ++k)
        if (const std::string fault = faultOf(*program.rigid()[k]); !fault.empty())
            return message("rigid body ", k, ": ", fault);
    return program.replayed() ? "" : "a restored state went another way";
}

}  // namespace

SoakCase soakCase(unsigned k, int acts)
{
    constexpr std::pair<WorldClass, Coupling> kWorlds[] = {{WorldClass::softRigid, Coupling::swap},
                                                           {WorldClass::softRigid, Coupling::coupled},
                                                           {WorldClass::softMultiBody, Coupling::swap},
                                                           {WorldClass::deformable, Coupling::swap}};
    SoakCase soak;
    std::tie(soak.m_world, soak.m_coupling) = kWorlds[k % 4];
    soak.m_manner = k / 4 % 2 == 0 ? Manner::gentle : Manner::hostile;
    soak.m_number = k;
    for (int a = 0; a < acts; ++a) soak.m_acts.push_back(a);
    return soak;
}

std::string nameOf(const SoakCase& soak)
{
    return message(worldName(soak.m_world), " ", couplingName(soak.m_coupling), " ",
                   soak.m_manner == Manner::gentle ? "gentle" : "hostile", " ", soak.m_number);
}

SoakOutcome run(const SoakCase& soak, void (*watch)(int act, RandomProgram& program))
{
    SoakOutcome outcome;
    RandomProgram program(soak.m_world, soak.m_coupling, soak.m_number, soak.m_manner);
    for (const int act : soak.m_acts)
    {
        try
        {
            const long before = program.steps();
            program.act(static_cast<unsigned>(act));
            if (watch) watch(act, program);
            if (program.steps() > before) outcome.m_fault = faultOf(program, soak.m_manner);
        }
        catch (const std::exception& error)
        {
            outcome.m_fault = "it threw: " + reasonOf(error);
        }
        if (outcome.m_fault.empty()) continue;
        outcome.m_fault = message("act ", act, " (", program.lastAct(), "): ", outcome.m_fault);
        break;
    }
    outcome.m_steps = program.steps();
    outcome.m_refusals = program.refusals();
    return outcome;
}

}  // namespace bullet_fem

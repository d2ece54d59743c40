// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// btFemSoftBodySolver: actuators, that is chambers, cables, fibres and expansions.
#include "bullet_fem/btFemActuators.h"

#include <algorithm>
#include <stdexcept>
#include <string>

#include "BulletSoftBody/btSoftBody.h"
#include "bullet_fem/btFemSoftBodySolver.h"
#include "bullet_fem/fem/body/active_stress.h"
#include "fem/common/attempt.h"
#include "plugin/joints/btFemActuatorConversion.h"
#include "plugin/record/btFemBodyRecord.h"
#include "plugin/record/btFemCoupling.h"

using namespace bullet_fem;

namespace
{

const TetMesh& meshOf(const FemSoftBody& fem)
{
    return fem.m_body.m_model->mesh();
}

// The actuator with this handle. Throws std::invalid_argument if there is none.
template <class T>
T& find(std::vector<T>& all, int id, const char* kind)
{
    for (T& one : all)
        if (one.m_id == id) return one;
    throw std::invalid_argument(std::string("the body has no ") + kind + " " + std::to_string(id) +
                                "; give what the function that added it returned");
}

// Changes a copy of an actuator, validates it, and assigns it.
template <class T, class Change>
void changeOne(const FemSoftBody& fem, T& known, const Change& change)
{
    T changed = known;
    change(changed);
    changed.validate(meshOf(fem));
    known = std::move(changed);
}

// Appends a validated actuator and returns its handle.
template <class T>
int append(FemSoftBody& fem, std::vector<T>& all, T added)
{
    added.m_id = ++fem.m_joints.m_lastId;
    all.push_back(std::move(added));
    return all.back().m_id;
}

// Changes actuators that cause stress. Restores the former ones if the stress is out of range.
template <class Change>
void changeActiveStress(FemSoftBody& fem, const Change& change)
{
    Actuators& actuators = fem.m_body.m_actuators;
    const auto fibres = actuators.m_fibres;
    const auto expansions = actuators.m_expansions;
    if (!actuators.hasActiveStress()) actuators.m_ownStress = fem.m_body.m_state.m_initialStress;
    try
    {
        change(actuators);
        applyActiveStress(fem.m_body);
    }
    catch (...)
    {
        actuators.m_fibres = fibres;
        actuators.m_expansions = expansions;
        throw;
    }
}

// Validates and appends an actuator that causes stress, and returns its handle.
template <class T>
int appendStress(FemSoftBody& fem, std::vector<T> Actuators::*all, const T& added)
{
    added.validate(meshOf(fem));
    int handle = 0;
    changeActiveStress(fem, [&](Actuators& a) { handle = append(fem, a.*all, added); });
    return handle;
}

// Returns call(FEM body) unless the body is not FEM or is being stepped. Exceptions get the caller's name.
template <class Call>
auto withFem(btFemSoftBodySolver& solver, const btSoftBody* body, const char* caller, const Call& call)
{
    btFemBodyRecord& record = btFemCoupling::femRecord(solver, body, caller);
    if (record.m_work.m_stage == btFemStage::free || record.m_work.m_stage == btFemStage::solved)
        throw std::invalid_argument(std::string(caller) + ": the body is being stepped; call it between steps");
    try
    {
        return call(record.fem());
    }
    catch (const std::invalid_argument& error)
    {
        throw std::invalid_argument(std::string(caller) + ": " + error.what());
    }
}

template <class T>
bool removeFrom(std::vector<T>& all, int id)
{
    const auto gone = std::remove_if(all.begin(), all.end(), [id](const T& one) { return one.m_id == id; });
    const bool found = gone != all.end();
    all.erase(gone, all.end());
    return found;
}

}  // namespace

int btFemSoftBodySolver::addChamber(btSoftBody* body, const btFemChamber& chamber, std::string* why)
{
    const auto add = [&](FemSoftBody& fem)
    {
        Chamber added = coreChamber(chamber);
        added.validate(meshOf(fem));
        added.validateVolume(fem.m_body.m_state.m_x);
        return append(fem, fem.m_body.m_actuators.m_chambers, std::move(added));
    };
    return attemptValue(why, [&] { return withFem(*this, body, "addChamber", add); });
}

bool btFemSoftBodySolver::setChamberPressure(btSoftBody* body, int chamber, btScalar pressure, std::string* why)
{
    const auto set = [&](FemSoftBody& fem)
    {
        changeOne(fem, find(fem.m_body.m_actuators.m_chambers, chamber, "chamber"),
                  [&](Chamber& c)
                  {
                      c.m_isSealed = false;
                      c.m_pressure = pressure;
                  });
    };
    return attempt(why, [&] { withFem(*this, body, "setChamberPressure", set); });
}

bool btFemSoftBodySolver::setChamberGas(btSoftBody* body, int chamber, btScalar gas, std::string* why)
{
    const auto set = [&](FemSoftBody& fem)
    {
        changeOne(fem, find(fem.m_body.m_actuators.m_chambers, chamber, "chamber"),
                  [&](Chamber& c)
                  {
                      c.m_isSealed = true;
                      c.m_gas = gas;
                  });
    };
    return attempt(why, [&] { withFem(*this, body, "setChamberGas", set); });
}

bool btFemSoftBodySolver::sealChamber(btSoftBody* body, int chamber, std::string* why)
{
    const auto seal = [&](FemSoftBody& fem)
    {
        const std::vector<Vec3>& x = fem.m_body.m_state.m_x;
        Chamber& known = find(fem.m_body.m_actuators.m_chambers, chamber, "chamber");
        if (known.m_isSealed) return;
        known.validateVolume(x);
        changeOne(fem, known,
                  [&](Chamber& c)
                  {
                      c.m_isSealed = true;
                      c.m_gas = (c.m_pressure + c.m_outsidePressure) * c.volume(x);
                  });
    };
    return attempt(why, [&] { withFem(*this, body, "sealChamber", seal); });
}

int btFemSoftBodySolver::addCable(btSoftBody* body, const btFemCable& cable, std::string* why)
{
    const auto add = [&](FemSoftBody& fem)
    {
        Cable added = coreCable(cable);
        added.validate(meshOf(fem));
        return append(fem, fem.m_body.m_actuators.m_cables, std::move(added));
    };
    return attemptValue(why, [&] { return withFem(*this, body, "addCable", add); });
}

bool btFemSoftBodySolver::setCableTension(btSoftBody* body, int cable, btScalar tension, std::string* why)
{
    const auto set = [&](FemSoftBody& fem)
    {
        changeOne(fem, find(fem.m_body.m_actuators.m_cables, cable, "cable"),
                  [&](Cable& c)
                  {
                      if (c.m_stiffness > 0)
                          throw std::invalid_argument("the cable stretches, with " + std::to_string(c.m_stiffness) +
                                                      " N/m; call setCableRestLength");
                      c.m_tension = tension;
                  });
    };
    return attempt(why, [&] { withFem(*this, body, "setCableTension", set); });
}

bool btFemSoftBodySolver::setCableRestLength(btSoftBody* body, int cable, btScalar length, std::string* why)
{
    const auto set = [&](FemSoftBody& fem)
    {
        changeOne(
            fem, find(fem.m_body.m_actuators.m_cables, cable, "cable"),
            [&](Cable& c)
            {
                if (!(c.m_stiffness > 0))
                    throw std::invalid_argument("the cable has a tension, and no stiffness; call setCableTension");
                c.m_restLength = length;
            });
    };
    return attempt(why, [&] { withFem(*this, body, "setCableRestLength", set); });
}

int btFemSoftBodySolver::addFibres(btSoftBody* body, const btFemFibres& fibres, std::string* why)
{
    const auto add = [&](FemSoftBody& fem) { return appendStress(fem, &Actuators::m_fibres, coreFibres(fibres)); };
    return attemptValue(why, [&] { return withFem(*this, body, "addFibres", add); });
}

bool btFemSoftBodySolver::setActivation(btSoftBody* body, int fibres, btScalar activation, std::string* why)
{
    const auto set = [&](FemSoftBody& fem)
    {
        Fibres& known = find(fem.m_body.m_actuators.m_fibres, fibres, "fibres");
        changeActiveStress(fem,
                           [&](Actuators&) { changeOne(fem, known, [&](Fibres& c) { c.m_activation = activation; }); });
    };
    return attempt(why, [&] { withFem(*this, body, "setActivation", set); });
}

int btFemSoftBodySolver::addExpansion(btSoftBody* body, const btFemExpansion& expansion, std::string* why)
{
    const auto add = [&](FemSoftBody& fem)
    { return appendStress(fem, &Actuators::m_expansions, coreExpansion(expansion)); };
    return attemptValue(why, [&] { return withFem(*this, body, "addExpansion", add); });
}

bool btFemSoftBodySolver::setExpansion(btSoftBody* body, int expansion, btScalar strain, std::string* why)
{
    const auto set = [&](FemSoftBody& fem)
    {
        Expansion& known = find(fem.m_body.m_actuators.m_expansions, expansion, "expansion");
        changeActiveStress(fem, [&](Actuators&) { changeOne(fem, known, [&](Expansion& c) { c.m_strain = strain; }); });
    };
    return attempt(why, [&] { withFem(*this, body, "setExpansion", set); });
}

bool btFemSoftBodySolver::removeActuator(btSoftBody* body, int actuator, std::string* why)
{
    const auto remove = [&](FemSoftBody& fem)
    {
        Actuators& a = fem.m_body.m_actuators;
        if (removeFrom(a.m_chambers, actuator) || removeFrom(a.m_cables, actuator)) return;
        if (!removeFrom(a.m_fibres, actuator) && !removeFrom(a.m_expansions, actuator)) return;
        applyActiveStress(fem.m_body);
        if (!a.hasActiveStress()) a.m_ownStress.clear();
    };
    return attempt(why, [&] { withFem(*this, body, "removeActuator", remove); });
}

bool btFemSoftBodySolver::getActuators(const btSoftBody* body,
                                       btAlignedObjectArray<btFemActuatorReport>& actuators) const
{
    actuators.resize(0);
    const btFemBodyRecord* record = body ? btFemCoupling::record(*this, *body) : nullptr;
    if (!record || !record->isFem()) return false;
    const Actuators& all = record->fem().m_body.m_actuators;
    const std::vector<Vec3>& x = record->fem().m_body.m_state.m_x;
    const auto report = [&](btFemActuatorKind kind, int id) -> btFemActuatorReport&
    {
        actuators.push_back(btFemActuatorReport());
        btFemActuatorReport& last = actuators[actuators.size() - 1];
        last.m_kind = kind;
        last.m_actuator = id;
        return last;
    };
    for (const Chamber& chamber : all.m_chambers)
    {
        btFemActuatorReport& r = report(btFemActuatorKind::chamber, chamber.m_id);
        const double volume = chamber.volume(x);
        r.m_volume = static_cast<btScalar>(volume);
        r.m_pressure = static_cast<btScalar>(chamber.pressureAt(volume));
    }
    for (const Cable& cable : all.m_cables)
    {
        btFemActuatorReport& r = report(btFemActuatorKind::cable, cable.m_id);
        const double length = cable.length(x);
        r.m_length = static_cast<btScalar>(length);
        r.m_tension = static_cast<btScalar>(cable.tensionAt(length));
    }
    for (const Fibres& fibres : all.m_fibres)
        report(btFemActuatorKind::fibres, fibres.m_id).m_activation = static_cast<btScalar>(fibres.m_activation);
    for (const Expansion& expansion : all.m_expansions)
        report(btFemActuatorKind::expansion, expansion.m_id).m_strain = static_cast<btScalar>(expansion.m_strain);
    return true;
}

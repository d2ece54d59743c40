// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "BulletSoftBody/btSoftBody.h"
#include "bullet_bridge/body/body_arrays.h"
#include "bullet_fem/btFemSoftBodySolver.h"
#include "plugin/record/btFemBodyRecord.h"
#include "plugin/record/btFemCoupling.h"

using namespace bullet_fem;

namespace
{

// Null if the body is not FEM, or its arrays were changed.
const btFemBodyRecord* femRecordOf(const btFemSoftBodySolver& solver, const btSoftBody* body)
{
    const btFemBodyRecord* record = body ? btFemCoupling::record(solver, *body) : nullptr;
    return record && record->isFem() && arraysAsSetUp(record->fem()) ? record : nullptr;
}

// Stresses of the body's elements or nodes; null if the body is not FEM, or its arrays were changed.
const std::vector<Stress>* stressesOf(const btFemSoftBodySolver& solver, const btSoftBody* body, bool perNode)
{
    const btFemBodyRecord* record = femRecordOf(solver, body);
    if (!record) return nullptr;
    btFemStressScratch& scratch = btFemCoupling::stressScratch(solver);
    elementStresses(record->fem().m_body, scratch.m_perElement);
    if (!perNode) return &scratch.m_perElement;
    nodeStresses(*record->fem().m_body.m_model, scratch.m_perElement, scratch.m_perNode);
    return &scratch.m_perNode;
}

template <class Value, class Convert>
bool convert(const std::vector<Stress>* stresses, btAlignedObjectArray<Value>& out, const Convert& converted)
{
    out.resize(stresses ? static_cast<int>(stresses->size()) : 0);
    for (int i = 0; i < out.size(); ++i) out[i] = converted((*stresses)[i]);
    return stresses != nullptr;
}

btFemStress toBullet(const Stress& s)
{
    return {btScalar(s.xx), btScalar(s.yy), btScalar(s.zz), btScalar(s.xy), btScalar(s.yz), btScalar(s.xz)};
}

btScalar vonMisesToBullet(const Stress& s)
{
    return static_cast<btScalar>(vonMises(s));
}

}  // namespace

btScalar btFemStress::vonMises() const
{
    return vonMisesToBullet({m_xx, m_yy, m_zz, m_xy, m_yz, m_xz});
}

bool btFemSoftBodySolver::getStress(const btSoftBody* body, btAlignedObjectArray<btFemStress>& perElement) const
{
    return convert(stressesOf(*this, body, false), perElement, toBullet);
}

bool btFemSoftBodySolver::getNodeStress(const btSoftBody* body, btAlignedObjectArray<btFemStress>& perNode) const
{
    return convert(stressesOf(*this, body, true), perNode, toBullet);
}

bool btFemSoftBodySolver::getVonMises(const btSoftBody* body, btAlignedObjectArray<btScalar>& perElement) const
{
    return convert(stressesOf(*this, body, false), perElement, vonMisesToBullet);
}

bool btFemSoftBodySolver::getNodeVonMises(const btSoftBody* body, btAlignedObjectArray<btScalar>& perNode) const
{
    return convert(stressesOf(*this, body, true), perNode, vonMisesToBullet);
}

bool btFemSoftBodySolver::getPlasticStrain(const btSoftBody* body, btAlignedObjectArray<btScalar>& perElement) const
{
    const btFemBodyRecord* record = femRecordOf(*this, body);
    const std::vector<double>* strain = record ? &record->fem().m_body.m_state.m_equivalentPlasticStrain : nullptr;
    perElement.resize(strain ? static_cast<int>(strain->size()) : 0);
    for (int e = 0; e < perElement.size(); ++e) perElement[e] = static_cast<btScalar>((*strain)[e]);
    return perElement.size() > 0;
}

bool btFemSoftBodySolver::getActivation(const btSoftBody* body, btAlignedObjectArray<btScalar>& perElement) const
{
    perElement.resizeNoInitialize(0);
    const btFemBodyRecord* record = femRecordOf(*this, body);
    if (!record || record->fem().m_body.m_actuators.m_fibres.empty()) return false;
    perElement.resize(body->m_tetras.size(), btScalar(0));
    for (const Fibres& fibres : record->fem().m_body.m_actuators.m_fibres)
    {
        const auto activation = static_cast<btScalar>(fibres.m_activation);
        for (const int e : fibres.m_elements) perElement[e] += activation;
        for (int e = 0; e < perElement.size() && fibres.m_elements.empty(); ++e) perElement[e] += activation;
    }
    return true;
}

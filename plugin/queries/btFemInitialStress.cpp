// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "bullet_fem/fem/body/initial_stress.h"

#include "BulletSoftBody/btSoftBody.h"
#include "bullet_fem/btFemSoftBodySolver.h"
#include "bullet_fem/fem/body/active_stress.h"
#include "fem/common/attempt.h"
#include "plugin/record/btFemBodyRecord.h"
#include "plugin/record/btFemCoupling.h"

using namespace bullet_fem;

bool btFemSoftBodySolver::setInitialStress(btSoftBody* body, const btAlignedObjectArray<btFemStress>& perElement,
                                           std::string* why)
{
    const auto set = [&]
    {
        btFemBodyRecord& record = btFemCoupling::femRecord(*this, body, "setInitialStress");
        std::vector<SymmetricTensor>& stress = btFemCoupling::stressScratch(*this).m_perElement;
        stress.clear();
        for (int e = 0; e < perElement.size(); ++e)
        {
            const btFemStress& s = perElement[e];
            stress.push_back({s.m_xx, s.m_yy, s.m_zz, s.m_xy, s.m_yz, s.m_xz});
        }
        Body& fem = record.fem().m_body;
        if (!fem.m_actuators.hasActiveStress()) return bullet_fem::setInitialStress(fem, stress);
        fem.m_actuators.m_ownStress.swap(stress);
        try
        {
            applyActiveStress(fem);
        }
        catch (...)
        {
            fem.m_actuators.m_ownStress.swap(stress);
            throw;
        }
    };
    return attempt(why, set);
}

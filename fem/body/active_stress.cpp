// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "bullet_fem/fem/body/active_stress.h"

#include "bullet_fem/fem/body/initial_stress.h"
#include "fem/body/actuator_limits.h"

namespace bullet_fem
{

static_assert(kMaxActivation == kMaxInitialStress);

namespace
{

// Calls visit(index in the list, element) for the listed elements, or for all if the list is empty.
template <class Visit>
void forEachElement(const Body& body, const std::vector<int>& listed, const Visit& visit)
{
    const int count = listed.empty() ? body.m_model->mesh().tetCount() : static_cast<int>(listed.size());
    for (int k = 0; k < count; ++k) visit(k, listed.empty() ? k : listed[k]);
}

void addFibreStress(const Body& body, const Fibres& fibres, std::vector<SymmetricTensor>& stress)
{
    forEachElement(body, fibres.m_elements,
                   [&](int k, int e)
                   {
                       const Vec3& f = fibres.m_directions[fibres.m_directions.size() == 1 ? 0 : k];
                       const Mat3 along = (1 / dot(f, f)) * outer(f, f);
                       stress[e] += fibres.m_activation * symmetricPart(along);
                   });
}

// Adds -C (strain I), which equals -3 K strain I for an isotropic element.
void addExpansionStress(const Body& body, const Expansion& expansion, std::vector<SymmetricTensor>& stress)
{
    const RestShape& shape = body.m_model->shape();
    forEachElement(body, expansion.m_elements,
                   [&](int, int e)
                   {
                       if (shape.isOrthotropic())
                       {
                           const double s = -expansion.m_strain;
                           stress[e] += stressOf(shape.stiffnessOf(e), {s, s, s, 0, 0, 0});
                           return;
                       }
                       const RestElement& element = shape.m_elements[e];
                       const double bulk = (element.m_lambdaVolume + 2.0 / 3 * element.m_muVolume) / element.m_volume;
                       const double pressure = -3 * bulk * expansion.m_strain;
                       stress[e] += {pressure, pressure, pressure, 0, 0, 0};
                   });
}

}  // namespace

void applyActiveStress(Body& body)
{
    const Actuators& actuators = body.m_actuators;
    if (!actuators.hasActiveStress()) return setInitialStress(body, actuators.m_ownStress);
    std::vector<SymmetricTensor> stress = actuators.m_ownStress;
    stress.resize(body.m_model->mesh().tets().size());
    for (const Fibres& fibres : actuators.m_fibres) addFibreStress(body, fibres, stress);
    for (const Expansion& expansion : actuators.m_expansions) addExpansionStress(body, expansion, stress);
    setInitialStress(body, stress);
}

}  // namespace bullet_fem

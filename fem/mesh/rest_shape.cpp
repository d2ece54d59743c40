// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "bullet_fem/fem/mesh/rest_shape.h"

#include <cmath>
#include <utility>

#include "bullet_fem/fem/mesh/thin_mesh.h"
#include "fem/common/message.h"

namespace bullet_fem
{
namespace
{

void validateScales(const TetMesh& mesh, const std::vector<double>& filled, double massScale)
{
    if (!(massScale > 0) || !std::isfinite(massScale)) reject("mass scale ", massScale, " is not in (0, inf)");
    if (!filled.empty() && static_cast<int>(filled.size()) != mesh.tetCount())
        reject("filled fractions: ", filled.size(), " given for ", mesh.tetCount(), " elements; give one each or none");
    for (std::size_t e = 0; e < filled.size(); ++e)
        if (!(filled[e] > 0 && filled[e] <= 1))
            reject("filled fraction of element ", e, " is ", filled[e],
                   ", not in (0, 1]; drop empty elements from the mesh");
}

}  // namespace

std::vector<double> lumpedMasses(const TetMesh& mesh, const std::vector<double>& filled, double density)
{
    Material material;
    material.m_density = density;
    return lumpedMasses(mesh, filled, material, 1);
}

std::vector<double> lumpedMasses(const TetMesh& mesh, const std::vector<double>& filled,
                                 const ElementMaterials& materials, double massScale)
{
    std::vector<double> mass(mesh.nodeCount(), 0.0);
    for (int e = 0; e < mesh.tetCount(); ++e)
    {
        const double density = materials.of(e).m_density * massScale;
        for (int node : mesh.tets()[e])
            mass[node] += density * mesh.tetVolume(e) * (filled.empty() ? 1.0 : filled[e]) / 4;
    }
    return mass;
}

RestShape::RestShape(TetMesh mesh, ElementMaterials materials, const std::vector<double>& filled, double massScale)
    : m_mesh(std::move(mesh)), m_materials(std::move(materials))
{
    m_materials.validate(m_mesh.tetCount());
    m_material = m_materials.first();
    validateScales(m_mesh, filled, massScale);
    std::vector<LameModuli> moduli;  // moduli of each region
    for (const auto& [label, material] : m_materials.m_regions)
    {
        moduli.push_back({material.lameMu(), material.lameLambda()});
        if (m_materials.isOrthotropic()) m_regionStiffness.push_back(material.stiffness());
    }
    const std::vector<Vec3>& X = m_mesh.restPositions();
    m_elements.resize(m_mesh.tets().size());
    m_lumpedMass.assign(X.size(), 0.0);
    for (int e = 0; e < m_mesh.tetCount(); ++e)
    {
        const Tet& tet = m_mesh.tets()[e];
        const Material& material = materialOf(e);
        const double density = material.m_density > 0 ? material.m_density : 1;
        const Vec3& X0 = X[tet[0]];
        RestElement& element = m_elements[e];
        element.m_DmInverse = inverse(Mat3::fromColumns(X[tet[1]] - X0, X[tet[2]] - X0, X[tet[3]] - X0));
        element.m_volume = m_mesh.tetVolume(e) * (filled.empty() ? 1.0 : filled[e]);
        element.m_lambdaVolume = moduli[m_materials.regionOf(e)].m_lambda * element.m_volume;
        element.m_muVolume = moduli[m_materials.regionOf(e)].m_mu * element.m_volume;
        for (int node : tet) m_lumpedMass[node] += density * massScale * element.m_volume / 4;
    }
    m_isThin = m_materials.choosesBending() && isThinSomewhere(m_mesh);
    const ElementMaterials chosen = chosenMaterials();
    if (!chosen.usesMeanDilatation()) return;
    m_patches = ElementPatches(m_mesh, chosen.patchGroups());
    m_patchVolume.assign(m_patches.count(), 0.0);
    for (int e = 0; e < m_mesh.tetCount(); ++e) m_patchVolume[m_patches.m_patch[e]] += m_elements[e].m_volume;
    if (!chosen.bendsAccurately()) return;
    std::vector<double> volume;
    for (const RestElement& element : m_elements) volume.push_back(element.m_volume);
    m_assumedStrain = AssumedStrain(m_mesh, chosen, m_patches, volume);
}

double RestShape::lawSizeOf(int e) const
{
    if (m_assumedStrain.empty()) return std::cbrt(m_mesh.tetVolume(e));
    const int patch = m_patches.m_patch[e];
    double volume = 0;
    for (int k = m_patches.m_start[patch]; k < m_patches.m_start[patch + 1]; ++k)
        volume += m_mesh.tetVolume(m_patches.m_element[k]);
    return std::cbrt(volume);
}

double RestShape::shareOfPatch(int e) const
{
    return m_patches.empty() ? 1 : m_elements[e].m_volume / m_patchVolume[m_patches.m_patch[e]];
}

}  // namespace bullet_fem

// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "plugin/setup/btFemBodyMaterials.h"

#include <cstddef>
#include <stdexcept>
#include <string>

#include "BulletSoftBody/btSoftBody.h"
#include "bullet_bridge/body/face_tree.h"
#include "bullet_fem/btFemVectors.h"
#include "fem/common/message.h"
#include "plugin/registry/btFemBodyRegistry.h"
#include "plugin/setup/btFemBodySetUp.h"
#include "plugin/setup/btFemMaterialConversion.h"

using namespace bullet_fem;

namespace
{

// `where` are the parts of a message that name one of several materials.
template <class... Parts>
Material checkedMaterial(const btFemMaterial& material, const Parts&... where)
{
    std::string why;
    if (!material.valid(&why)) reject("btFemMaterial", where..., ": ", why);
    return coreMaterial(material);
}

void checkCount(std::size_t given, const char* what, const RestMesh& rest)
{
    if (static_cast<int>(given) != rest.m_mesh.tetCount())
        reject("setMaterials: ", given, " ", what, " are given for ", rest.m_mesh.tetCount(),
               " tetrahedra; give one for each, in the order of m_tetras");
}

}  // namespace

void giveMaterials(btFemBodyRegistry& registry, btSoftBody* body, const btFemMaterialMaker& make)
{
    if (registry.find(body)) registry.record(body);  // record() detects changes by the program
    std::string why;
    if (!canBecomeFem(body, why)) reject("setMaterial: ", why);
    const btFemBodyRecord* known = registry.find(body);
    const RestMesh rest = known ? restMeshNow(*known) : restMeshOf(*body);
    ElementMaterials materials = make(rest);
    materials.validate(rest.m_mesh.tetCount());
    keepFaceTree(*body);
    btFemBodyRecord& record = registry.record(body);
    if (materials.first().m_density > 0) writeMasses(*body, massesAtRest(rest.m_mesh, *body, materials));
    record.m_asked.m_materials = std::move(materials);
    record.m_asked.m_materialGiven = true;
    record.m_asked.m_materialChanged = true;
    record.m_model.m_rejected = false;
}

btFemMaterialMaker materialOfAll(const btFemMaterial& material)
{
    return [core = checkedMaterial(material)](const RestMesh&) { return ElementMaterials(core); };
}

btFemMaterialMaker materialsOfTets(const std::vector<btFemMaterial>& perTet)
{
    std::vector<Material> core;
    for (const btFemMaterial& material : perTet)
        core.push_back(checkedMaterial(material, " of tetrahedron ", core.size()));
    return [core](const RestMesh& rest)
    {
        checkCount(core.size(), "materials", rest);
        return ElementMaterials::ofElements(core);
    };
}

btFemMaterialMaker materialsOfRegions(const std::vector<int>& labels, const std::map<int, btFemMaterial>& ofLabel)
{
    std::map<int, Material> core;
    for (const auto& [label, material] : ofLabel) core.emplace(label, checkedMaterial(material, " of region ", label));
    return [labels, core](const RestMesh& rest)
    {
        checkCount(labels.size(), "region labels", rest);
        return ElementMaterials::ofLabels(labels, core);
    };
}

btFemMaterialMaker materialsByPlace(const std::function<btFemMaterial(const btVector3& centroid)>& materialAt)
{
    if (!materialAt) reject("setMaterials: the function is empty; give one, or a material to setMaterial");
    return [materialAt](const RestMesh& rest)
    {
        std::vector<Material> perTet;
        for (const Tet& tet : rest.m_mesh.tets())
        {
            Vec3 place = rest.m_origin;
            for (const int node : tet) place += 0.25 * rest.m_mesh.restPositions()[node];
            perTet.push_back(checkedMaterial(materialAt(bulletVector(place)), " of tetrahedron ", perTet.size(),
                                             " at (", place.x, ", ", place.y, ", ", place.z, ") m"));
        }
        return ElementMaterials::ofElements(perTet);
    };
}

// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include <memory>
#include <stdexcept>
#include <utility>

#include "bullet_fem/fem/baked/baked_body.h"
#include "bullet_fem/fem/mesh/rest_shape.h"
#include "fem/common/attempt.h"
#include "fem/common/message.h"
#include "fem/common/single.h"

namespace bullet_fem
{
namespace
{

constexpr double kWaterDensity = 1000;  // [kg/m3]

/// Rounding to the precision of a Bullet build.
struct Rounding
{
    bool m_single;

    double operator()(double value) const { return m_single ? roundedToSingle(value) : value; }
    Vec3 operator()(const Vec3& v) const { return {(*this)(v.x), (*this)(v.y), (*this)(v.z)}; }
    Material operator()(Material m) const
    {
        // The maximum is not rounded: the plug-in, too, maps its rounded value to it.
        constexpr double kMaxPoisson = Material::kMaxPoissonRatio;
        if (m.m_poissonRatio != kMaxPoisson) m.m_poissonRatio = (*this)(m.m_poissonRatio);
        for (double* value : {&m.m_youngModulus, &m.m_density, &m.m_massDamping, &m.m_stiffnessDamping,
                              &m.m_yieldStress, &m.m_hardeningModulus, &m.m_plasticCreep, &m.m_mostPlasticStrain})
            *value = (*this)(*value);
        for (PronyTerm& term : m.m_relaxation) term = {(*this)(term.m_share), (*this)(term.m_time)};
        for (double& constant : m.m_lawConstants) constant = (*this)(constant);
        Orthotropic& orthotropic = m.m_orthotropic;
        for (auto* constants : {&orthotropic.m_young, &orthotropic.m_poisson, &orthotropic.m_shear})
            for (double& value : *constants) value = (*this)(value);
        for (Vec3* direction : {&orthotropic.m_along, &orthotropic.m_across}) *direction = (*this)(*direction);
        return m;
    }
    ElementMaterials operator()(ElementMaterials materials) const
    {
        for (MaterialRegion& region : materials.m_regions) region.m_material = (*this)(region.m_material);
        return materials;
    }
};

std::vector<unsigned char> fixedNodes(const TetMesh& mesh, const std::vector<int>& pins)
{
    std::vector<unsigned char> fixed(mesh.nodeCount(), 0);
    for (int i = 0; i < mesh.nodeCount(); ++i) fixed[i] = mesh.isLoose(i) ? 1 : 0;
    for (const int i : pins)
    {
        if (i < 0 || i >= mesh.nodeCount())
            reject("pinned node ", i, " is not in [0, ", mesh.nodeCount(), "); give nodes of the mesh");
        fixed[i] = 1;
    }
    return fixed;
}

// Relative to the first node, as the bridge reads a body's nodes.
TetMesh meshAround(const std::vector<Vec3>& positions, const std::vector<Tet>& tets)
{
    std::vector<Vec3> X = positions;
    for (Vec3& x : X) x -= positions[0];
    TetMesh mesh(std::move(X), tets, LooseNodes::kept);
    if (mesh.turnedCount() > 0)
        reject("rounding to Bullet's single precision turns ", mesh.turnedCount(),
               " elements inside out; move the mesh towards the origin or make it coarser");
    return mesh;
}

/// The arguments of bakeBody().
struct Given
{
    const TetMesh& m_mesh;
    std::vector<double> m_filled;
    double m_massScale = 1;
};

// Sets the masses as the plug-in does: with a density those of the rounded mesh, as setMaterial; without one water's,
// as btFemHelpers.
void setMasses(BakedBody& body, const Given& given, const RestShape& shape, const Rounding& round)
{
    const bool own = shape.m_material.m_density > 0;
    const std::vector<double> mass =
        own ? lumpedMasses(shape.m_mesh, body.m_filled, shape.m_materials, body.m_massScale)
            : lumpedMasses(given.m_mesh, given.m_filled, kWaterDensity * given.m_massScale);
    for (std::size_t i = 0; i < mass.size(); ++i)
        body.m_inverseMass.push_back(mass[i] > 0 ? round(1 / (own ? mass[i] : round(mass[i]))) : 1);
}

ElementMaterials materialsOf(const BakeSettings& settings)
{
    if (settings.m_labels.empty()) return settings.m_material;
    return ElementMaterials::ofLabels(settings.m_labels, settings.m_regionMaterials);
}

BakedBody bakeMesh(const Given& given, const BakeSettings& settings)
{
    if (given.m_mesh.tetCount() == 0) reject("bakeBody: the mesh is empty; build it from elements");
    const Rounding round{settings.m_singlePrecision};
    BakedBody body;
    body.m_singlePrecision = settings.m_singlePrecision;
    body.m_massScale = round(given.m_massScale);
    bool filled = false;
    for (const double fraction : given.m_filled)
    {
        body.m_filled.push_back(round(fraction));
        filled = filled || body.m_filled.back() < 1;
    }
    if (!filled) body.m_filled.clear();
    for (const Vec3& X : given.m_mesh.restPositions()) body.m_positions.push_back(round(X));
    const ElementMaterials materials = materialsOf(settings);
    materials.validate(given.m_mesh.tetCount());
    auto shape = std::make_shared<const RestShape>(meshAround(body.m_positions, given.m_mesh.tets()), round(materials),
                                                   body.m_filled);
    setMasses(body, given, *shape, round);

    FactorInput input;
    for (const double inverse : body.m_inverseMass) input.m_mass.push_back(1 / inverse);
    input.m_fixed = fixedNodes(shape->m_mesh, settings.m_pins);
    input.m_step = roundedToSingle(settings.m_step);  // as the plug-in does in either precision
    input.m_choice = settings.m_choice;
    input.m_maxBytes = settings.m_maxBytes;
    body.m_model = BodyModel::create(std::move(shape), std::move(input));
    return body;
}

BakedBody bakeCage(const Cage& cage, const SurfaceMesh& surface, const BakeSettings& settings)
{
    if (cage.m_embedding.size() != surface.m_vertices.size())
        reject("bakeBody: the cage embeds ", cage.m_embedding.size(), " vertices, and the surface has ",
               surface.m_vertices.size(), "; give the surface that the cage was made of");
    BakedBody body = bakeMesh({cage.m_mesh, cage.m_filled, cage.m_massScale}, settings);
    body.m_embedding = cage.m_embedding;
    body.m_triangles = surface.m_triangles;
    body.m_surfaceCollides = cage.m_surfaceCollides;
    return body;
}

}  // namespace

BakedBody bakeBody(const TetMesh& mesh, const BakeSettings& settings, std::string* why)
{
    return attemptValue(why, [&] { return bakeMesh({mesh, {}, 1}, settings); });
}

BakedBody bakeBody(const Cage& cage, const SurfaceMesh& surface, const BakeSettings& settings, std::string* why)
{
    return attemptValue(why, [&] { return bakeCage(cage, surface, settings); });
}

}  // namespace bullet_fem

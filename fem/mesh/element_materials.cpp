// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "bullet_fem/fem/mesh/element_materials.h"

#include <algorithm>
#include <functional>
#include <string>
#include <unordered_map>
#include <utility>

#include "fem/common/message.h"
#include "fem/laws/law.h"

namespace bullet_fem
{
namespace
{

constexpr std::size_t kMaxNamed = 12;  // maximum number of labels in a message

std::string listOf(const std::map<int, Material>& materials)
{
    std::string list;
    std::size_t named = 0;
    for (const auto& [label, material] : materials)
    {
        if (named++ == kMaxNamed) return list + ", ...";
        list += (list.empty() ? "" : ", ") + std::to_string(label);
    }
    return list.empty() ? "none" : list;
}

// Checks the values that all regions of a body must share.
void checkWithFirst(const MaterialRegion& first, const MaterialRegion& region)
{
    const auto differ = [&](const char* what, double a, double b)
    {
        reject("the ", what, " of region ", region.m_label, " is ", b, ", and that of region ", first.m_label, " ", a,
               "; damping is a body's: give all its regions the same");
    };
    const Material &a = first.m_material, &b = region.m_material;
    if (a.m_massDamping != b.m_massDamping) differ("mass damping [1/s]", a.m_massDamping, b.m_massDamping);
    if (a.m_stiffnessDamping != b.m_stiffnessDamping)
        differ("stiffness damping [s]", a.m_stiffnessDamping, b.m_stiffnessDamping);
    if ((a.m_density > 0) != (b.m_density > 0))
        reject("the density of region ", region.m_label, " is ", b.m_density, " kg/m3, and that of region ",
               first.m_label, " ", a.m_density,
               "; 0 keeps the body's own node masses: give all its regions a density, or none");
}

// Refuses regions that need elements of different kinds.
void checkElements(const ElementMaterials& materials)
{
    const bool orthotropic = materials.isOrthotropic(), bends = materials.bendsAccurately();
    for (const auto& [label, material] : materials.m_regions)
    {
        const Law& law = lawOf(material.m_law);
        if (orthotropic && !bends && material.usesMeanDilatation())
            reject("region ", label, " has mean dilatation (nu ", material.m_poissonRatio,
                   ") beside an orthotropic region; switch it off in all regions of such a body, or give all of them "
                   "the law hooke");
        if (orthotropic && law.m_kind == LawKind::varying)
            reject("region ", label, " has the ", law.m_title,
                   " beside an orthotropic region; give one of them the law hooke");
    }
}

}  // namespace

ElementMaterials::ElementMaterials(std::vector<MaterialRegion> regions, std::vector<int> regionOf)
    : m_regions(std::move(regions)), m_regionOf(std::move(regionOf))
{
}

ElementMaterials ElementMaterials::ofLabels(const std::vector<int>& labels, const std::map<int, Material>& materials)
{
    std::map<int, int> index;  // index of every label that occurs
    for (std::size_t e = 0; e < labels.size(); ++e)
    {
        if (!index.emplace(labels[e], 0).second || materials.count(labels[e])) continue;
        reject("region ", labels[e], " (element ", e, " and ", std::count(labels.begin(), labels.end(), labels[e]) - 1,
               " more) has no material; there are materials for the regions: ", listOf(materials), "; give one for ",
               labels[e], ", too");
    }
    if (index.empty()) reject("there are no region labels; give one for every element");
    std::vector<MaterialRegion> regions;
    for (auto& [label, at] : index)
    {
        at = static_cast<int>(regions.size());
        regions.push_back({label, materials.at(label)});
    }
    std::vector<int> regionOf;
    for (std::size_t e = 0; e < labels.size() && regions.size() > 1; ++e) regionOf.push_back(index[labels[e]]);
    return {std::move(regions), std::move(regionOf)};
}

ElementMaterials ElementMaterials::ofElements(const std::vector<Material>& perElement)
{
    struct Hash
    {
        std::size_t operator()(const Material& m) const
        {
            const std::hash<double> hash;
            std::size_t sum = hash(m.m_youngModulus) ^ 3 * hash(m.m_poissonRatio) ^ 7 * hash(m.m_density);
            if (!m.isOrthotropic()) return sum;
            const Orthotropic& o = m.m_orthotropic;  // in a field of fibre directions, only these values differ
            for (const double value :
                 {o.m_young[0], o.m_along.x, o.m_along.y, o.m_along.z, o.m_across.x, o.m_across.y, o.m_across.z})
                sum = 31 * sum + hash(value);
            return sum;
        }
    };
    if (perElement.empty()) reject("there are no materials; give one for every element");
    std::vector<MaterialRegion> regions;
    std::vector<int> regionOf;
    std::unordered_map<Material, int, Hash> index;
    for (std::size_t e = 0; e < perElement.size(); ++e)
    {
        const auto [at, isNew] = index.emplace(perElement[e], static_cast<int>(regions.size()));
        if (isNew) regions.push_back({static_cast<int>(e), perElement[e]});
        regionOf.push_back(at->second);
    }
    if (regions.size() == 1) regionOf.clear();
    return {std::move(regions), std::move(regionOf)};
}

void ElementMaterials::validate(int elementCount) const
{
    if (m_regions.empty()) reject("there is no material; give one");
    for (const MaterialRegion& region : m_regions)
    {
        std::string why;
        if (!region.m_material.valid(&why))
            reject(m_regions.size() > 1 ? message("region ", region.m_label, ": ") : "", why);
        checkWithFirst(m_regions.front(), region);
    }
    checkElements(*this);
    if (isUniform() && m_regions.size() > 1)
        reject("there are ", m_regions.size(), " regions and no element is in one; give every element its region");
    if (!isUniform() && static_cast<int>(m_regionOf.size()) != elementCount)
        reject("there are materials for ", m_regionOf.size(), " elements, and the mesh has ", elementCount,
               "; give one for each");
    for (std::size_t e = 0; e < m_regionOf.size(); ++e)
        if (m_regionOf[e] < 0 || m_regionOf[e] >= static_cast<int>(m_regions.size()))
            reject("element ", e, " is in region ", m_regionOf[e], " of the table, not in [0, ", m_regions.size(), ")");
}

bool ElementMaterials::usesMeanDilatation() const
{
    return std::any_of(m_regions.begin(), m_regions.end(),
                       [](const MaterialRegion& region) { return region.m_material.usesMeanDilatation(); });
}

bool ElementMaterials::isNonlinear() const
{
    return std::any_of(m_regions.begin(), m_regions.end(),
                       [](const MaterialRegion& region)
                       { return lawOf(region.m_material.m_law).m_kind == LawKind::varying; });
}

bool ElementMaterials::isOrthotropic() const
{
    return std::any_of(m_regions.begin(), m_regions.end(),
                       [](const MaterialRegion& region) { return region.m_material.isOrthotropic(); });
}

bool ElementMaterials::bendsAccurately() const
{
    return std::any_of(m_regions.begin(), m_regions.end(),
                       [](const MaterialRegion& region) { return region.m_material.m_bending == Bending::accurate; });
}

bool ElementMaterials::choosesBending() const
{
    return std::any_of(m_regions.begin(), m_regions.end(),
                       [](const MaterialRegion& region) { return region.m_material.m_bending == Bending::automatic; });
}

ElementMaterials ElementMaterials::withBending(bool isThin) const
{
    ElementMaterials chosen = *this;
    for (auto& [label, material] : chosen.m_regions)
        if (material.m_bending == Bending::automatic)
            material.m_bending =
                isThin && material.m_meanDilatation != MeanDilatation::off ? Bending::accurate : Bending::plain;
    return chosen;
}

bool ElementMaterials::yields() const
{
    return std::any_of(m_regions.begin(), m_regions.end(),
                       [](const MaterialRegion& region) { return region.m_material.yields(); });
}

int ElementMaterials::relaxationTerms() const
{
    int most = 0;
    for (const MaterialRegion& region : m_regions) most = std::max(most, region.m_material.relaxationTerms());
    return most;
}

int ElementMaterials::historyCount() const
{
    int most = 0;
    for (const MaterialRegion& region : m_regions) most = std::max(most, lawOf(region.m_material.m_law).m_historyCount);
    return most;
}

std::vector<int> ElementMaterials::patchGroups() const
{
    std::unordered_map<std::size_t, std::vector<int>> alike;  // regions by hash of Young's modulus
    std::vector<int> group(m_regions.size());
    for (std::size_t r = 0; r < m_regions.size(); ++r)
    {
        const Material& material = m_regions[r].m_material;
        std::vector<int>& candidates = alike[std::hash<double>()(material.m_youngModulus)];
        const auto same = std::find_if(candidates.begin(), candidates.end(),
                                       [&](int other) { return m_regions[other].m_material == material; });
        group[r] = !material.usesMeanDilatation() ? kAlone
                   : same != candidates.end()     ? group[*same]
                                                  : static_cast<int>(r);
        candidates.push_back(static_cast<int>(r));
    }
    if (std::all_of(group.begin(), group.end(), [](int g) { return g == 0; })) return {};
    std::vector<int> perElement;
    for (const int r : m_regionOf) perElement.push_back(group[r]);
    return perElement;
}

}  // namespace bullet_fem

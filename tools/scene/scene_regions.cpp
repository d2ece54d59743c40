// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "tools/scene/scene_regions.h"

#include <charconv>
#include <string>
#include <system_error>
#include <vector>

namespace bullet_fem
{
namespace
{

int labelOf(const std::string& name, const JsonCursor& at)
{
    int label = 0;
    const char* const end = name.data() + name.size();
    const auto [stop, error] = std::from_chars(name.data(), end, label);
    if (error != std::errc() || stop != end)
        at.fail("must be called by the label of a region in the file, a whole number such as \"1\"");
    return label;
}

Material materialOrName(const JsonCursor& at, const SceneMaterials& known)
{
    return at.isObject() ? readMaterial(at, known) : materialCalled(at, known);
}

}  // namespace

std::map<int, Material> readRegionMaterials(const JsonCursor& at, const SceneMaterials& known)
{
    std::vector<std::string> names;
    const std::vector<JsonCursor> members = at.members(names);
    if (members.empty()) at.fail("is empty; give every region of the file a material");
    std::map<int, Material> materials;
    for (std::size_t i = 0; i < members.size(); ++i)
    {
        const int label = labelOf(names[i], members[i]);
        if (!materials.emplace(label, materialOrName(members[i], known)).second)
            members[i].fail("is of a region that has a material already");
    }
    return materials;
}

}  // namespace bullet_fem

// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "fem/elements/element_lanes.h"

#include <algorithm>
#include <numeric>

namespace bullet_fem
{
namespace
{

void standInOrder(int elements, ElementLanes& lanes)
{
    lanes.m_lane.resize(elements);
    std::iota(lanes.m_lane.begin(), lanes.m_lane.end(), 0);
    lanes.m_order = lanes.m_element = lanes.m_lane;
    lanes.m_element.resize((elements + kLanes - 1) / kLanes * kLanes, elements - 1);
}

void standInPatches(const ElementPatches& patches, ElementLanes& lanes)
{
    std::vector<int> bySize(patches.count());
    std::iota(bySize.begin(), bySize.end(), 0);
    std::stable_sort(bySize.begin(), bySize.end(), [&](int a, int b) { return patches.size(a) > patches.size(b); });
    lanes.m_lane.resize(patches.m_element.size());
    for (std::size_t first = 0; first < bySize.size(); first += kLanes)
    {
        const int firstLane = static_cast<int>(lanes.m_element.size()), blocks = patches.size(bySize[first]);
        const int* member = patches.m_element.data();
        lanes.m_groups.push_back({firstLane / kLanes, blocks});
        lanes.m_element.resize(firstLane + blocks * kLanes, member[patches.m_start[bySize[first]]]);
        for (std::size_t column = 0; column < kLanes && first + column < bySize.size(); ++column)
        {
            const int patch = bySize[first + column], start = patches.m_start[patch];
            for (int k = 0; k < blocks; ++k)
            {
                const int lane = firstLane + k * kLanes + static_cast<int>(column);
                const int element = member[start + std::min(k, patches.size(patch) - 1)];
                lanes.m_element[lane] = element;
                if (k >= patches.size(patch)) continue;
                lanes.m_lane[element] = lane;
                lanes.m_order.push_back(element);
            }
        }
    }
}

}  // namespace

ElementLanes::ElementLanes(const RestShape& shape)
{
    if (shape.m_patches.empty())
        standInOrder(shape.m_mesh.tetCount(), *this);
    else
        standInPatches(shape.m_patches, *this);
}

}  // namespace bullet_fem

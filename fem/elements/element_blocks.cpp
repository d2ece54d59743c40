// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "fem/elements/element_blocks.h"

#include <algorithm>
#include <cmath>
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

// Stores V C minus V times its part of lambda and mu.
template <class Real>
void storeStiffness(const ElasticMatrix& C, const RestElement& element, int lane, StiffnessBlock<Real>& block)
{
    const ElasticMatrix isotropic = isotropicStiffness({element.m_muVolume, element.m_lambdaVolume});
    int entry = 0;
    for (int i = 0; i < 6; ++i)
        for (int j = i; j < 6; ++j)
            block.m_entry[entry++][lane] = static_cast<Real>(element.m_volume * C(i, j) - isotropic(i, j));
}

LaneLaw laneLawOf(const Law& law)
{
    if (law.m_kind != LawKind::varying) return LaneLaw::linear;
    if (law.m_isInLanes) return LaneLaw::neoHooke;
    return law.m_hasVolumeRatio ? LaneLaw::single : LaneLaw::singleAllAtOnce;
}

bool needsSingle(const RestShape& shape)
{
    const auto isSingle = [](const MaterialRegion& region)
    { return laneLawOf(lawOf(region.m_material.m_law)) >= LaneLaw::single; };
    const std::vector<MaterialRegion>& regions = shape.m_materials.m_regions;
    return std::any_of(regions.begin(), regions.end(), isSingle);
}

SingleLane singleLane(const RestShape& shape, int e)
{
    const Material& material = shape.materialOf(e);
    const Law& law = lawOf(material.m_law);
    SingleLane lane;
    if (laneLawOf(law) < LaneLaw::single) return lane;
    lane.m_law = &law;
    lane.m_volume = shape.m_elements[e].m_volume;
    lane.m_mu = material.lameMu();
    lane.m_size = shape.lawSizeOf(e);
    lane.m_history = static_cast<std::size_t>(e) * shape.m_materials.historyCount();
    lane.m_constants = material.m_lawConstants;
    return lane;
}

}  // namespace

ElementLanes::ElementLanes(const RestShape& shape)
{
    if (shape.m_patches.empty())
        standInOrder(shape.m_mesh.tetCount(), *this);
    else
        standInPatches(shape.m_patches, *this);
}

template <class Real>
ElementBlocks<Real>::ElementBlocks(const RestShape& shape, const ElementLanes& lanes)
    : m_blocks(lanes.blockCount()),
      m_groups(lanes.m_groups),
      m_law(shape.m_materials.isNonlinear() ? lanes.blockCount() : 0),
      m_single(needsSingle(shape) ? lanes.m_element.size() : 0),
      m_share(hasPatches() ? lanes.blockCount() : 0),
      m_filter(shape.m_assumedStrain.empty() ? 0 : lanes.m_groups.size()),
      m_stiffness(shape.isOrthotropic() ? lanes.blockCount() : 0)
{
    for (int k = 0; k < blockCount() * kLanes; ++k)
    {
        const int e = lanes.m_element[k];
        const RestElement& element = shape.m_elements[e];
        const double stiffness = lanes.isCopy(k) ? 0 : 1;
        ElementBlock<Real>& block = m_blocks[k / kLanes];
        const int lane = k % kLanes;
        const Tet& tet = shape.m_mesh.tets()[e];
        for (int a = 0; a < 3; ++a)
        {
            const Vec3 edge = shape.m_mesh.restPositions()[tet[a + 1]] - shape.m_mesh.restPositions()[tet[0]];
            for (int c = 0; c < 3; ++c) block.m_Dm[3 * c + a][lane] = edge[c];
        }
        for (int i = 0; i < 9; ++i) block.m_DmInverse[i][lane] = static_cast<Real>(element.m_DmInverse(i / 3, i % 3));
        block.m_lambdaVolume[lane] = static_cast<Real>(stiffness * element.m_lambdaVolume);
        block.m_muVolume[lane] = static_cast<Real>(stiffness * element.m_muVolume);
        for (int a = 0; a < 4; ++a) block.m_node[lane][a] = tet[a];
        if (!m_law.empty())
            m_law[k / kLanes].m_lane[lane] = static_cast<Real>(laneLawOf(lawOf(shape.materialOf(e).m_law)));
        if (!m_single.empty() && !lanes.isCopy(k)) m_single[k] = singleLane(shape, e);
        if (shape.isOrthotropic() && !lanes.isCopy(k))
            storeStiffness(shape.stiffnessOf(e), element, lane, m_stiffness[k / kLanes]);
        if (hasPatches()) m_share[k / kLanes].m_lane[lane] = static_cast<Real>(stiffness * shape.shareOfPatch(e));
    }
    takeFilters(shape, lanes);
}

template <class Real>
void ElementBlocks<Real>::takeFilters(const RestShape& shape, const ElementLanes& lanes)
{
    for (std::size_t group = 0; group < m_filter.size(); ++group)
        for (int lane = 0; lane < kLanes; ++lane)
        {
            const int e = lanes.m_element[m_groups[group].m_firstBlock * kLanes + lane];
            const int patch = shape.m_patches.m_patch[e];
            const std::array<double, AssumedStrain::kEntries> H =
                assumesForAnyLaw() ? shape.m_assumedStrain.m_filter[patch] : shape.m_assumedStrain.square(patch);
            for (int k = 0; k < AssumedStrain::kEntries; ++k)
                m_filter[group].m_entry[k][lane] = static_cast<Real>(H[k]);
        }
}

template <class Real>
int ElementBlocks<Real>::workUnitsPerChunk() const
{
    return std::max(1, kBlocksPerChunk * workUnitCount() / blockCount());
}

template struct ElementBlocks<float>;
template struct ElementBlocks<double>;

NodeCorners::NodeCorners(const RestShape& shape, const ElementLanes& lanes)
    : m_start(shape.m_mesh.nodeCount() + 1, 0),
      m_corner(4 * shape.m_elements.size()),
      m_volume(lanes.m_element.size(), 0.0f),
      m_parity(lanes.m_element.size())
{
    const std::vector<Tet>& tets = shape.m_mesh.tets();
    for (const Tet& tet : tets)
        for (int node : tet) ++m_start[node + 1];
    for (int i = 0; i < nodeCount(); ++i) m_start[i + 1] += m_start[i];
    std::vector<int> next(m_start.begin(), m_start.end() - 1);
    for (const int element : lanes.m_order)
    {
        const int e = lanes.m_lane[element];
        m_volume[e] = static_cast<float>(shape.m_elements[element].m_volume);
        for (int a = 0; a < 4; ++a)
        {
            const int node = tets[element][a];
            m_parity[e][a] = (next[node] - m_start[node]) % 2;
            m_corner[next[node]++] = corner(e, a);
        }
    }
    for (int i = 0; i < nodeCount(); ++i)
    {
        float volumes[2] = {0, 0};
        for (int k = m_start[i]; k < m_start[i + 1]; ++k)
            volumes[(k - m_start[i]) % 2] += m_volume[element(m_corner[k])];
        m_volumeAround.push_back(volumes[0] + volumes[1]);
    }
}

}  // namespace bullet_fem

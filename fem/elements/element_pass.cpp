// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// Compiled once for every instruction set; selected at run time.
#include "fem/elements/element_pass.h"

#include "fem/common/vector_targets.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "fem/elements/element_pass.cpp"
#include <hwy/foreach_target.h>
// after foreach_target.h
#include <hwy/highway.h>

#include "fem/elements/assumed_strain-inl.h"
#include "fem/elements/response_elements-inl.h"

HWY_BEFORE_NAMESPACE();
namespace bullet_fem
{
namespace HWY_NAMESPACE
{

/// The nodal data of a vector of elements.
template <class Real>
struct StagedNodes
{
    StagedEdges<double, width<Real>()> m_x;
    StagedEdges<Real> m_v;

    HWY_INLINE void stage(const ElementPass<Real>& pass, const std::int32_t (*node)[4], Range lanes)
    {
        HWY_UNROLL(4)
        for (int lane = lanes.m_begin; lane < lanes.m_end; ++lane)
        {
            const std::int32_t own[4] = {node[lane][0], node[lane][1], node[lane][2], node[lane][3]};
            m_x.stageLane(lane, own, pass.m_x);
            m_v.stageLane(lane, own, pass.m_v);
        }
    }
};

/// The elements of a block from `lane` on, as many as a vector has lanes.
template <class Real>
struct PassLanes
{
    const ElementPass<Real>& m_pass;
    const StagedNodes<Real>& m_nodes;
    int m_block, m_lane;
    int m_group = 0;  // of patches

    HWY_INLINE const ElementBlock<Real>& block() const { return m_pass.m_elements->m_blocks[m_block]; }
    HWY_INLINE Quaternion* rotations() const { return m_pass.m_rotation + m_block * kLanes + m_lane; }

    HWY_INLINE Vector<Real> lambda() const { return hn::Load(Lanes<Real>(), block().m_lambdaVolume + m_lane); }
    HWY_INLINE Vector<Real> share() const
    {
        return hn::Load(Lanes<Real>(), m_pass.m_elements->m_share[m_block].m_lane + m_lane);
    }
    HWY_INLINE Vector<Real> mu() const { return hn::Load(Lanes<Real>(), block().m_muVolume + m_lane); }
    HWY_INLINE Vector<Real> law() const
    {
        return hn::Load(Lanes<Real>(), m_pass.m_elements->m_law[m_block].m_lane + m_lane);
    }
    HWY_INLINE Vector<Real> damping() const { return number<Real>(m_pass.m_damping); }
    HWY_INLINE Matrix<Real> DmInverse() const { return loadMatrix(block().m_DmInverse, m_lane); }
    HWY_INLINE Matrix<double> edges(int part) const { return m_nodes.m_x.load(part * width<double>()); }
    HWY_INLINE Matrix<double> restEdges(int part) const
    {
        return loadMatrix(block().m_Dm, m_lane + part * width<double>());
    }
    HWY_INLINE Matrix<Real> velocityEdges() const { return m_nodes.m_v.load(); }

    HWY_INLINE Vector<Real> filter(int entry) const
    {
        return hn::Load(Lanes<Real>(), m_pass.m_elements->m_filter[m_group].m_entry[entry] + m_lane);
    }
    HWY_INLINE bool hasInitialStress() const { return m_pass.m_initialStress != nullptr; }
    HWY_INLINE Symmetric<Real> initialStress() const
    {
        return loadSymmetric(m_pass.m_initialStress[m_block].m_entry, m_lane);
    }

    HWY_INLINE void storeForces(const Matrix<Real>& f) const { storeCorners(f, m_pass.m_force[m_block], m_lane); }
    HWY_INLINE void addForces(const Matrix<Real>& f) const
    {
        storeForces(plus(loadCorners(m_pass.m_force[m_block], m_lane), f));
    }

    HWY_INLINE void storeGradients(const Matrix<Real>& g) const
    {
        const Lanes<Real> d;
        WarpedBlock<Real>& out = m_pass.m_warped[m_block];
        HWY_UNROLL(9)
        for (int k = 0; k < 9; ++k) hn::Store(g.m[k % 3][k / 3], d, out.m_gradient[k] + m_lane);
    }

    HWY_INLINE void storeRotation(const Matrix<Real>& R) const
    {
        storeMatrix(R, m_pass.m_warped[m_block].m_gradient, m_lane);
    }
    HWY_INLINE Matrix<Real> loadRotation() const { return loadGradients(); }
    HWY_INLINE Matrix<Real> loadGradients() const { return loadMatrix(m_pass.m_warped[m_block].m_gradient, m_lane); }

    HWY_INLINE void storeTension(const Symmetric<Real>& T) const
    {
        storeSymmetric(T, m_pass.m_warped[m_block].m_tension, m_lane);
    }
    HWY_INLINE void storeTangentBlock(const Symmetric<Real>& C, Vector<Real> bulk, Vector<Real> patchBulk) const
    {
        const Lanes<Real> d;
        TangentBlock<Real>& out = m_pass.m_tangent[m_block];
        storeSymmetric(C, out.m_cofactor, m_lane);
        hn::Store(bulk, d, out.m_bulk + m_lane);
        hn::Store(patchBulk, d, out.m_patchBulk + m_lane);
    }

    HWY_INLINE void respondOneByOne(Vector<Real> lambda, Vector<Real> pressure, const Symmetric<Real>& e,
                                    ResponseLanes<Real>& law) const
    {
        respondSingly(*m_pass.m_elements, m_pass.m_history, m_block * kLanes + m_lane, lambda, pressure, e, law);
    }
};

template <class Real>
HWY_INLINE void passBlocks(const ElementPass<Real>& pass, Range blocks)
{
    constexpr int kN = width<Real>(), kVectors = kLanes / kN;  // vectors in a block
    StagedNodes<Real> staged[2][kBatch];
    Matrix<Real> F[kBatch];
    Quaternions<Real> q[kBatch];
    const int begin = blocks.m_begin * kVectors, end = blocks.m_end * kVectors;
    const auto nodes = [&](int k) { return pass.m_elements->m_blocks[k / kVectors].m_node + k % kVectors * kN; };

    for (int k = begin; k < HWY_MIN(begin + kBatch, end); ++k) staged[0][k - begin].stage(pass, nodes(k), {0, kN});
    for (int k = begin, turn = 0; k < end; k += kBatch, turn = 1 - turn)
    {
        const int count = HWY_MIN(kBatch, end - k);
        const auto lanes = [&](int i) {
            return PassLanes<Real>{pass, staged[turn][i], (k + i) / kVectors, (k + i) % kVectors * kN};
        };
        for (int i = 0; i < count; ++i)
        {
            F[i] = times(roundedEdges<Real>(lanes(i)), lanes(i).DmInverse());
            q[i] = loadQuaternions(lanes(i).rotations(), Real());
        }
        if (!pass.m_isRotated) polarRotations(F, count, q);
        for (int i = 0; i < count; ++i)
        {
            storeQuaternions(q[i], lanes(i).rotations());
            // Stages the next batch during the computation; at the end, the last vector once more.
            const auto next = nodes(HWY_MIN(k + kBatch + i, end - 1));
            const auto stageNext = [&](int part) {
                staged[1 - turn][i].stage(pass, next, {part * kN / 4, (part + 1) * kN / 4});
            };
            const auto withGiven = [&](const Symmetric<Real>& elastic) {
                return pass.m_initialStress ? withInitialStress(lanes(i), q[i], strainAgain(lanes(i), q[i]), elastic)
                                            : elastic;
            };
            if (pass.m_tangent)
            {
                const ResponseLanes<Real> law = passResponses(lanes(i), q[i], stageNext);
                storeTangent(lanes(i), law, number<Real>(0), tensionOf(pass.m_tensionFactor, withGiven(law.m_stress)));
                continue;
            }
            const Symmetric<Real> stress = withGiven(passElements(lanes(i), q[i], stageNext));
            lanes(i).storeTension(tensionOf(pass.m_tensionFactor, stress));
        }
    }
}

/// Some elements of a column of patches, at most kBatch.
struct PatchBatch
{
    int m_column, m_first;
};

/// Patch: PatchStrains or PatchResponses.
template <class Patch, class Real>
HWY_INLINE void passPatches(const ElementPass<Real>& pass, Range groups)
{
    constexpr int kN = width<Real>(), kVectors = kLanes / kN;
    const std::vector<PatchGroup>& all = pass.m_elements->m_groups;
    const int end = groups.m_end * kVectors;
    const auto column = [&all](int c) { return patchColumn<Real>(all, c); };
    const auto after = [&](const PatchBatch& batch)
    {
        const bool isLast = batch.m_first + kBatch >= column(batch.m_column).m_size;
        return isLast ? PatchBatch{batch.m_column + 1, 0} : PatchBatch{batch.m_column, batch.m_first + kBatch};
    };
    StagedNodes<Real> staged[2][kBatch];
    const auto stage = [&](const PatchBatch& batch, int i, int slot)
    {
        if (batch.m_column >= end || batch.m_first + i >= column(batch.m_column).m_size) return;
        const PatchColumn in = column(batch.m_column);
        const int b = in.m_block + batch.m_first + i;
        staged[slot][i].stage(pass, pass.m_elements->m_blocks[b].m_node + in.m_lane, {0, kN});
    };
    Patch patch;
    PatchBatch batch = {groups.m_begin * kVectors, 0};
    for (int i = 0; i < kBatch; ++i) stage(batch, i, 0);
    for (int turn = 0; batch.m_column < end; turn = 1 - turn)
    {
        const PatchColumn in = column(batch.m_column);
        const PatchBatch next = after(batch);
        const auto lanes = [&](int k) {
            return PassLanes<Real>{pass, staged[turn][k - batch.m_first], in.m_block + k, in.m_lane, in.m_group};
        };
        const int count = HWY_MIN(kBatch, in.m_size - batch.m_first);
        Matrix<Real> F[kBatch];
        Quaternions<Real> q[kBatch];
        for (int i = 0; i < count; ++i)
        {
            const PassLanes<Real> elements = lanes(batch.m_first + i);
            F[i] = times(roundedEdges<Real>(elements), elements.DmInverse());
            q[i] = loadQuaternions(elements.rotations(), Real());
        }
        if (!pass.m_isRotated) polarRotations(F, count, q);
        for (int i = 0; i < kBatch; ++i)
        {
            stage(next, i, 1 - turn);
            if (i >= count) continue;
            storeQuaternions(q[i], lanes(batch.m_first + i).rotations());
            patch.add(batch.m_first + i, lanes(batch.m_first + i), q[i]);
        }
        if (next.m_column != batch.m_column)
            for (int k = 0; k < in.m_size; ++k)
            {
                const PassLanes<Real> elements = {pass, staged[turn][0], in.m_block + k, in.m_lane, in.m_group};
                Symmetric<Real> stress = patch.finish(k, elements);
                if (pass.m_initialStress)
                    stress = withInitialStress(elements, loadQuaternions(elements.rotations(), Real()),
                                               patch.m_strain[k], stress);
                patch.storeTension(elements, tensionOf(pass.m_tensionFactor, stress));
            }
        batch = next;
    }
}

template <class Real>
HWY_INLINE void passAssumedPatches(const ElementPass<Real>& pass, Range groups)
{
    StagedNodes<Real> staged[2][ElementPatches::kMax];
    PatchAssumed<Real> patch;
    const auto stage = [&](const PatchColumn& column, int k, int slot)
    {
        const ElementBlock<Real>& block = pass.m_elements->m_blocks[column.m_block + k];
        staged[slot][k].stage(pass, block.m_node + column.m_lane, {0, width<Real>()});
    };
    const auto compute = [&](const PatchColumn& column, int slot, const auto& other)
    {
        const auto lanes = [&](int k) {
            return PassLanes<Real>{pass, staged[slot][k], column.m_block + k, column.m_lane, column.m_group};
        };
        for (int k = 0; k < column.m_size; ++k) patch.addGradient(k, lanes(k));
        Quaternions<Real> q = loadQuaternions(lanes(0).rotations(), Real());
        if (!pass.m_isRotated) polarRotations(&patch.m_gradient.m_mean, 1, &q);
        patch.setFrame(q);
        for (int k = 0; k < column.m_size; ++k)
        {
            storeQuaternions(q, lanes(k).rotations());
            patch.add(k, lanes(k));
        }
        for (int k = 0; k < column.m_size; ++k) patch.respond(k, lanes(k));
        for (int k = 0; k < column.m_size; ++k)
        {
            other(k);
            lanes(k).storeTension(tensionOf(pass.m_tensionFactor, patch.finish(k, lanes(k))));
        }
    };
    forEachColumn<Real>(pass.m_elements->m_groups, groups, stage, compute);
}

template <class Real>
void passUnits(const ElementPass<Real>& pass, Range pieces)
{
    if (!pass.m_elements->hasPatches()) return passBlocks(pass, pieces);
    if (pass.m_tangent) return passPatches<PatchResponses<Real>>(pass, pieces);
    if (!pass.m_elements->m_filter.empty()) return passAssumedPatches(pass, pieces);
    passPatches<PatchStrains<Real>>(pass, pieces);
}

/// Strains of the elements of a column in the frames of their patches.
template <class Real>
HWY_INLINE void strainColumn(const ElementStrains<Real>& strains, const PatchColumn& column)
{
    constexpr int kN = width<Real>();
    StagedEdges<double, kN> staged[ElementPatches::kMax];
    const ElementBlocks<Real>& all = *strains.m_elements;
    const auto rotation = [&](int k) { return strains.m_rotation + (column.m_block + k) * kLanes + column.m_lane; };
    const auto lanes = [&](int k) {
        return DeformedLanes<Real>{all.m_blocks[column.m_block + k], staged[k], column.m_lane};
    };
    MeanGradient<Real> gradient;
    for (int k = 0; k < column.m_size; ++k)
    {
        staged[k].stage(all.m_blocks[column.m_block + k].m_node + column.m_lane, strains.m_x);
        const Vector<Real> share = hn::Load(Lanes<Real>(), all.m_share[column.m_block + k].m_lane + column.m_lane);
        gradient.add(k, share, times(roundedEdges<Real>(lanes(k)), lanes(k).DmInverse()));
    }
    Quaternions<Real> q = loadQuaternions(rotation(0), Real());
    polarRotations(&gradient.m_mean, 1, &q);
    const Matrix<Real> R = toMatrix(q, number<Real>(2));
    for (int k = 0; k < column.m_size; ++k)
    {
        storeQuaternions(q, rotation(k));
        const Symmetric<Real> E = strainInFrameOf(R, times(edgesMinusRotated(lanes(k), q), lanes(k).DmInverse()));
        storeSymmetric(withoutDoubling(E), strains.m_strain[column.m_block + k].m_entry, column.m_lane);
    }
}

template <class Real>
void strainPatches(const ElementStrains<Real>& strains, Range groups)
{
    constexpr int kVectors = kLanes / width<Real>();
    for (int c = groups.m_begin * kVectors; c < groups.m_end * kVectors; ++c)
        strainColumn(strains, patchColumn<Real>(strains.m_elements->m_groups, c));
}

template <class Real>
void strainBlocks(const ElementStrains<Real>& strains, Range blocks)
{
    constexpr int kN = width<Real>();
    if (!strains.m_elements->m_filter.empty()) return strainPatches(strains, blocks);
    for (int b = blocks.m_begin; b < blocks.m_end; ++b)
        for (int lane = 0; lane < kLanes; lane += kN)
        {
            const ElementBlock<Real>& block = strains.m_elements->m_blocks[b];
            StagedEdges<double, kN> staged;
            staged.stage(block.m_node + lane, strains.m_x);
            const DeformedLanes<Real> elements = {block, staged, lane};
            Quaternion* rotation = strains.m_rotation + b * kLanes + lane;
            const Matrix<Real> F = times(roundedEdges<Real>(elements), elements.DmInverse());
            Quaternions<Real> q = loadQuaternions(rotation, Real());
            polarRotations(&F, 1, &q);
            storeQuaternions(q, rotation);
            const Symmetric<Real> E = strainInFrameOf(toMatrix(q, number<Real>(2)),
                                                      times(edgesMinusRotated(elements, q), elements.DmInverse()));
            storeSymmetric(withoutDoubling(E), strains.m_strain[b].m_entry, lane);
        }
}

BULLETFEM_KERNEL(passUnits, ElementPass)
BULLETFEM_KERNEL(strainBlocks, ElementStrains)

}  // namespace HWY_NAMESPACE
}  // namespace bullet_fem
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace bullet_fem
{

BULLETFEM_EXPORT_KERNEL(passUnits, ElementPass, runElementPass)
BULLETFEM_EXPORT_KERNEL(strainBlocks, ElementStrains, runElementStrains)

}  // namespace bullet_fem
#endif

// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <memory>
#include <vector>

#include "bullet_fem/fem/common/threads.h"
#include "fem/common/aligned_array.h"
#include "fem/factor/node_entry.h"
#include "fem/factor/panel_kernels.h"
#include "fem/factor/subtrees.h"
#include "fem/factor/supernode_tree.h"

namespace bullet_fem
{

/// A block factor A0 = L D L^T, packed in single precision for the two triangular solves of a preconditioner. Supernode
/// s holds S_s = D_s^-1 and M_s, its rows of L below the unit diagonal block, so that a solve consists of products:
/// forward y_below -= M y_s; backward y_s = S y_s - M^T y_below. A factor of numbers is applied to the three directions
/// of nodes in one pass over its panels. Constant once packed.
class PackedFactor
{
public:
    PackedFactor() = default;

    /// Memory of the panels of a factor of this pattern [B].
    static std::size_t bytesFor(const SupernodeTree& tree, NodeEntry entry = NodeEntry::block);

    /// A factor of this pattern, initialized with zeros. Allocates.
    explicit PackedFactor(SupernodeTree tree, NodeEntry entry = NodeEntry::block);

    /// A factor packed before: `panels` are its floatCount() floats, aligned to 64 bytes, shared without copying.
    PackedFactor(SupernodeTree tree, NodeEntry entry, std::shared_ptr<const float> panels);

    /// Sets supernode s of a factor constructed without panels: S is k nc x k nc and symmetric, M is k nr x k nc, k =
    /// rowsOfNode(entry()), both column-major.
    void pack(int supernode, const double* S, const double* M);

    const SupernodeTree& tree() const { return m_tree; }
    NodeEntry entry() const { return m_entry; }
    int size() const { return 3 * m_tree.m_nodeCount; }
    std::size_t byteCount() const { return sizeof(float) * floatCount(); }

    /// The panels of all supernodes, consecutive. Equal on all machines of one byte order, whatever their vectors; null
    /// without nodes.
    const float* panels() const { return m_panels.get(); }
    std::size_t floatCount() const { return m_panelStart.empty() ? 0 : m_panelStart.back(); }

    /// Floats of solve()'s vector, including its working rows, and of its scratch.
    std::size_t vectorSize() const { return 3 * static_cast<std::size_t>(m_division.m_rowCount); }
    std::size_t scratchSize() const { return m_scratchStart.back(); }

    /// y <- A0^-1 y in the first size() of vectorSize() entries; the others are scratch. `scratch` is aligned to 64
    /// bytes. Bitwise independent of the number of threads; `threads` null: the calling thread alone.
    void solve(float* y, float* scratch, const Threads* threads = nullptr) const;

    /// y <- A0^-1 y for kPanelLanes interleaved vectors of a factor of blocks, each bitwise equal to solve(): y has
    /// vectorSize() * kPanelLanes entries, scratch batchScratchSize(), both aligned to 64 bytes.
    void solveBatch(float* y, float* scratch) const;
    std::size_t batchScratchSize() const;

    /// Scratch entries [floats] of solveLanes().
    std::size_t laneScratchSize() const { return kPanelLanes * scratchOf(m_scratchRows); }

    /// y <- A0^-1 y for kPanelLanes interleaved right-hand sides: y has size() * kPanelLanes entries, aligned to 64
    /// bytes. Solves forward along the supernodes of `forward` and backward along those of `backward` only (ascending):
    /// for a sparse right-hand side the ancestors of its entries, and for a few wanted entries of the solution theirs.
    void solveLanes(const std::vector<int>& forward, const std::vector<int>& backward, float* y, float* scratch) const;

    /// All supernodes, ascending.
    const std::vector<int>& allSupernodes() const { return m_all; }

private:
    std::size_t scratchOf(std::size_t rows) const { return m_entry == NodeEntry::block ? rows : 3 * rows; }
    struct Kernels;
    Kernels kernels() const;
    void solve(const Kernels& kernels, float* y, float* scratch, const Threads* threads) const;
    Panel panel(int supernode) const;
    Panel forwardPanelOf(int supernode) const;
    void layOutPanels();
    void layOutScratch();
    void addRowsAbove(const Kernels& kernels, float* y) const;

    NodeEntry m_entry = NodeEntry::block;
    SupernodeTree m_tree;
    TreeDivision m_division{SupernodeTree()};
    std::vector<int> m_all;
    std::vector<std::size_t> m_panelStart;  // per supernode, then the end, in floats
    std::shared_ptr<const float> m_panels;
    float* m_packing = nullptr;                     // m_panels while packing; null if they were packed before
    std::size_t m_scratchRows = 0;                  // rows of the longest panel
    std::vector<std::size_t> m_scratchStart = {0};  // per subtree, then the top and the end, in floats
};

}  // namespace bullet_fem

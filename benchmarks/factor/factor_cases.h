// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "bullet_fem/fem/factor/body_model.h"
#include "fem/factor/block_matrix.h"
#include "fem/factor/fill_order.h"

namespace bullet_fem
{

/// A body whose matrix A0 is factored; unless stated otherwise h = 1/60 s, beta = 0.01 s, E = 1e6 Pa and nu = 0.3.
struct FactorCase
{
    std::string m_name;
    std::shared_ptr<const RestShape> m_shape;
    FactorInput m_input;
};

/// A0 of a case over its free nodes.
struct FactorSystem
{
    explicit FactorSystem(const FactorCase& factorCase);

    BlockMatrix m_A0;              ///< over all nodes [kg]
    std::vector<int> m_freeNodes;  ///< ascending
    SparsePattern m_pattern;       ///< of A0 over the free nodes
    double m_lowerEntries = 0;     ///< entries of A0's lower half over the free nodes, including the diagonal
};

/// The clamped beam of 4 x 1 x 1 m with 24 n^3 elements, n cells per metre in [1, 32].
FactorCase beamCase(int cellsPerMetre);

/// A free cube of 6 n^3 elements, n in [1, 100]: the compact body with the largest fill.
FactorCase cubeCase(int cells);

using FactorCaseMaker = std::function<FactorCase()>;

/// Thirty bodies that cover the inputs of a factorization: beams, plates, cubes, balls, cylinders, cages, pins, several
/// components, loose nodes, slivers, stiff and nearly incompressible materials.
std::vector<FactorCaseMaker> thirtyFactorCases();

}  // namespace bullet_fem

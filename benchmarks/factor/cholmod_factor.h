// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "benchmarks/factor/lower_matrix.h"

namespace bullet_fem
{

/// SuiteSparse's CHOLMOD, the factorization that the field knows, in double precision on one thread. Debian's binary is
/// under the GPL, so it is the reference of tests and benchmarks alone, which are never installed.
class CholmodFactor
{
public:
    enum class Kind
    {
        supernodal,
        simplicial  ///< L D L^T, its fastest for a column at a time
    };

    enum class Order
    {
        own,     ///< the best that CHOLMOD finds with its default strategy: AMD, then METIS
        natural  ///< the matrix's
    };

    /// Analyses: order and symbolic factorization. `A` must outlive this. Throws std::runtime_error naming CHOLMOD's
    /// status, here and below.
    CholmodFactor(const LowerMatrix& A, Kind kind, Order order);
    ~CholmodFactor();

    void factorize();

    /// b <- A^-1 b for `columns` right-hand sides one after the other; copies in and out are part of CHOLMOD's solve.
    std::vector<double> solve(const std::vector<double>& b, int columns);

    double entries() const;     ///< of L
    std::size_t bytes() const;  ///< that CHOLMOD keeps for the factor
    /// L by columns, as A = L L^T; the factor cannot be used any more.
    LowerMatrix takeL();

private:
    struct Impl;
    std::unique_ptr<Impl> m_impl;
};

/// "CHOLMOD x.y.z, <BLAS that its supernodal code calls>".
std::string cholmodVersion();

}  // namespace bullet_fem

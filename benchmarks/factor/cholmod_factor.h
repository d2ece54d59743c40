// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "benchmarks/factor/lower_matrix.h"

namespace bullet_fem
{

/// SuiteSparse's CHOLMOD factorization in double precision on one thread, as a reference. Debian's binary is under the
/// GPL; it is therefore used only by tests and benchmarks, which are never installed.
class CholmodFactor
{
public:
    enum class Kind
    {
        supernodal,
        simplicial  ///< L D L^T, CHOLMOD's fastest column-by-column method
    };

    enum class Order
    {
        own,     ///< the best of CHOLMOD's default strategy: AMD, then METIS
        natural  ///< the order of the matrix
    };

    /// Analyses A: fill-reducing order and symbolic factorization. `A` must outlive this object. Throws
    /// std::runtime_error with CHOLMOD's status; so do the other functions.
    CholmodFactor(const LowerMatrix& A, Kind kind, Order order);
    ~CholmodFactor();

    void factorize();

    /// b <- A^-1 b for `columns` right-hand sides, one after another; includes CHOLMOD's copies in and out.
    std::vector<double> solve(const std::vector<double>& b, int columns);

    double entries() const;     ///< of L
    std::size_t bytes() const;  ///< memory that CHOLMOD keeps for the factor
    /// L by columns, with A = L L^T; the factor is unusable afterwards.
    LowerMatrix takeL();

private:
    struct Impl;
    std::unique_ptr<Impl> m_impl;
};

/// "CHOLMOD x.y.z, <BLAS called by its supernodal code>".
std::string cholmodVersion();

}  // namespace bullet_fem

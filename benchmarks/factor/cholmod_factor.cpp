// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// The only file that uses CHOLMOD.
#include "benchmarks/factor/cholmod_factor.h"

#include <cholmod.h>
#include <dlfcn.h>

#include <stdexcept>

namespace bullet_fem
{
namespace
{

constexpr int kLowerHalf = -1;  // cholmod_sparse::stype

/// A function of the BLAS that this program is linked to; null if that BLAS does not export it.
template <class Function>
Function* blasFunction(const char* name)
{
    return reinterpret_cast<Function*>(dlsym(RTLD_DEFAULT, name));
}

void useOneThread()
{
    if (auto* setThreads = blasFunction<void(int)>("openblas_set_num_threads")) setThreads(1);
}

std::string blasName()
{
    auto* config = blasFunction<char*()>("openblas_get_config");
    if (config) return config();
    Dl_info info;
    void* gemm = dlsym(RTLD_DEFAULT, "dgemm_");
    return gemm && dladdr(gemm, &info) ? info.dli_fname : "unknown BLAS";
}

}  // namespace

struct CholmodFactor::Impl
{
    cholmod_common m_common;
    cholmod_sparse m_A;
    cholmod_factor* m_L = nullptr;

    Impl() { cholmod_start(&m_common); }
    ~Impl()
    {
        cholmod_free_factor(&m_L, &m_common);
        cholmod_finish(&m_common);
    }

    void check(const char* what) const
    {
        if (m_common.status != CHOLMOD_OK)
            throw std::runtime_error(std::string("CHOLMOD: ") + what + " failed with status " +
                                     std::to_string(m_common.status));
    }
};

CholmodFactor::CholmodFactor(const LowerMatrix& A, Kind kind, Order order) : m_impl(new Impl)
{
    useOneThread();
    cholmod_common& common = m_impl->m_common;
    common.print = 0;
    common.supernodal = kind == Kind::supernodal ? CHOLMOD_SUPERNODAL : CHOLMOD_SIMPLICIAL;
    if (order == Order::natural)
    {
        common.nmethods = 1;
        common.method[0].ordering = CHOLMOD_NATURAL;
        common.postorder = false;
    }
    cholmod_sparse& view = m_impl->m_A;
    view = {};
    view.nrow = view.ncol = A.m_size;
    view.nzmax = A.m_row.size();
    view.p = const_cast<int*>(A.m_columnStart.data());
    view.i = const_cast<int*>(A.m_row.data());
    view.x = const_cast<double*>(A.m_value.data());
    view.stype = kLowerHalf;
    view.itype = CHOLMOD_INT;
    view.xtype = CHOLMOD_REAL;
    view.dtype = CHOLMOD_DOUBLE;
    view.sorted = view.packed = true;
    m_impl->m_L = cholmod_analyze(&view, &common);
    m_impl->check("the analysis");
}

CholmodFactor::~CholmodFactor() = default;

void CholmodFactor::factorize()
{
    cholmod_factorize(&m_impl->m_A, m_impl->m_L, &m_impl->m_common);
    m_impl->check("the factorization");
}

std::vector<double> CholmodFactor::solve(const std::vector<double>& b, int columns)
{
    cholmod_dense right = {};
    right.nrow = right.d = m_impl->m_A.nrow;
    right.ncol = columns;
    right.nzmax = b.size();
    right.x = const_cast<double*>(b.data());
    right.xtype = CHOLMOD_REAL;
    right.dtype = CHOLMOD_DOUBLE;
    cholmod_dense* solution = cholmod_solve(CHOLMOD_A, m_impl->m_L, &right, &m_impl->m_common);
    m_impl->check("the solve");
    const double* x = static_cast<const double*>(solution->x);
    std::vector<double> result(x, x + b.size());
    cholmod_free_dense(&solution, &m_impl->m_common);
    return result;
}

double CholmodFactor::entries() const
{
    return m_impl->m_common.lnz;
}

std::size_t CholmodFactor::bytes() const
{
    const cholmod_factor& L = *m_impl->m_L;
    if (L.is_super) return L.xsize * sizeof(double) + L.ssize * sizeof(int);
    return L.nzmax * (sizeof(double) + sizeof(int));
}

LowerMatrix CholmodFactor::takeL()
{
    cholmod_change_factor(CHOLMOD_REAL, true, false, true, true, m_impl->m_L, &m_impl->m_common);
    m_impl->check("the conversion to L L^T");
    cholmod_sparse* sparse = cholmod_factor_to_sparse(m_impl->m_L, &m_impl->m_common);
    m_impl->check("the conversion to a matrix");
    LowerMatrix L;
    L.m_size = static_cast<int>(sparse->nrow);
    const int* start = static_cast<const int*>(sparse->p);
    const int* row = static_cast<const int*>(sparse->i);
    const double* value = static_cast<const double*>(sparse->x);
    L.m_columnStart.assign(start, start + L.m_size + 1);
    L.m_row.assign(row, row + start[L.m_size]);
    L.m_value.assign(value, value + start[L.m_size]);
    cholmod_free_sparse(&sparse, &m_impl->m_common);
    return L;
}

std::string cholmodVersion()
{
    return "CHOLMOD " + std::to_string(CHOLMOD_MAIN_VERSION) + '.' + std::to_string(CHOLMOD_SUB_VERSION) + '.' +
           std::to_string(CHOLMOD_SUBSUB_VERSION) + ", " + blasName();
}

}  // namespace bullet_fem

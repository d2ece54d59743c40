// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// The only file that uses AMD and METIS. CMake defines BULLETFEM_WITH_SUITESPARSE and BULLETFEM_WITH_METIS if the
// library is linked.
#include "fem/factor/ordering_libraries.h"

#ifdef BULLETFEM_WITH_SUITESPARSE
#include <amd.h>
#endif
#ifdef BULLETFEM_WITH_METIS
#include <metis.h>
#endif

#include <mutex>
#include <new>
#include <stdexcept>

namespace bullet_fem
{
namespace
{

[[maybe_unused]] [[noreturn]] void failed(const char* library, int status)
{
    throw std::runtime_error(std::string("fill-reducing order: ") + library + " failed with status " +
                             std::to_string(status));
}

[[maybe_unused]] std::string version(const char* library, int major, int minor, int patch)
{
    return std::string(library) + ' ' + std::to_string(major) + '.' + std::to_string(minor) + '.' +
           std::to_string(patch);
}

}  // namespace

#ifdef BULLETFEM_WITH_SUITESPARSE
std::string amdVersion()
{
    return version("AMD", AMD_MAIN_VERSION, AMD_SUB_VERSION, AMD_SUBSUB_VERSION);
}

// AMD orders the pattern of A + A^T, so one triangle suffices.
std::vector<int> amdOrder(const SparsePattern& pattern)
{
    if (pattern.m_size == 0) return {};  // AMD accepts no null pointers
    std::vector<int> order(pattern.m_size);
    const int status = amd_order(pattern.m_size, pattern.m_columnStart.data(), pattern.m_rowIndex.data(), order.data(),
                                 nullptr, nullptr);
    if (status == AMD_OUT_OF_MEMORY) throw std::bad_alloc();
    if (status != AMD_OK && status != AMD_OK_BUT_JUMBLED) failed("AMD", status);
    return order;
}
#else
std::string amdVersion()
{
    return {};
}

std::vector<int> amdOrder(const SparsePattern&)
{
    return {};
}
#endif

#ifdef BULLETFEM_WITH_METIS
std::string metisVersion()
{
    return version("METIS", METIS_VER_MAJOR, METIS_VER_MINOR, METIS_VER_SUBMINOR);
}

std::vector<int> metisOrder(const SparsePattern& pattern)
{
    PatternGraph<idx_t> graph(pattern);  // METIS's input format
    if (graph.m_neighbour.empty()) return {};
    idx_t count = pattern.m_size;
    std::vector<idx_t> order(count), place(count);
    // METIS seeds and uses the C library's global random generator: concurrent calls would change the orders.
    static std::mutex generator;
    const std::lock_guard<std::mutex> turn(generator);
    const int status = METIS_NodeND(&count, graph.m_start.data(), graph.m_neighbour.data(), nullptr, nullptr,
                                    order.data(), place.data());
    if (status == METIS_ERROR_MEMORY) throw std::bad_alloc();
    if (status != METIS_OK) failed("METIS", status);
    return std::vector<int>(order.begin(), order.end());
}
#else
std::string metisVersion()
{
    return {};
}

std::vector<int> metisOrder(const SparsePattern&)
{
    return {};
}
#endif

}  // namespace bullet_fem

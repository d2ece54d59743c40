// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// The only file that knows METIS.
#include <metis.h>

#include <mutex>
#include <new>
#include <stdexcept>
#include <string>

#include "fem/factor/nested_dissection.h"

namespace bullet_fem
{
namespace
{

// Both triangles without the diagonal, as METIS reads them.
struct MetisGraph
{
    std::vector<idx_t> m_start, m_neighbour;

    explicit MetisGraph(const SparsePattern& pattern) : m_start(pattern.m_size + 1, 0)
    {
        forEdges(pattern, [this](int a, int b) { ++m_start[a + 1], ++m_start[b + 1]; });
        for (int i = 0; i < pattern.m_size; ++i) m_start[i + 1] += m_start[i];
        m_neighbour.resize(m_start.back());
        std::vector<idx_t> end(m_start.begin(), m_start.end() - 1);
        forEdges(pattern, [&](int a, int b) { m_neighbour[end[a]++] = b, m_neighbour[end[b]++] = a; });
    }

    template <class Visit>
    static void forEdges(const SparsePattern& pattern, const Visit& visit)
    {
        for (int c = 0; c < pattern.m_size; ++c)
            for (int k = pattern.m_columnStart[c]; k < pattern.m_columnStart[c + 1]; ++k)
                if (pattern.m_rowIndex[k] != c) visit(pattern.m_rowIndex[k], c);
    }
};

}  // namespace

const char* nestedDissectionLibrary()
{
    static const std::string name = "METIS " + std::to_string(METIS_VER_MAJOR) + "." + std::to_string(METIS_VER_MINOR) +
                                    "." + std::to_string(METIS_VER_SUBMINOR);
    return name.c_str();
}

std::vector<int> nestedDissectionOrder(const SparsePattern& pattern)
{
    MetisGraph graph(pattern);
    if (graph.m_neighbour.empty()) return {};
    idx_t count = pattern.m_size;
    std::vector<idx_t> order(count), place(count);
    // METIS seeds the C library's one random generator and draws from it: in turn, or orders would differ.
    static std::mutex generator;
    const std::lock_guard<std::mutex> turn(generator);
    const int status = METIS_NodeND(&count, graph.m_start.data(), graph.m_neighbour.data(), nullptr, nullptr,
                                    order.data(), place.data());
    if (status == METIS_ERROR_MEMORY) throw std::bad_alloc();
    if (status != METIS_OK)
        throw std::runtime_error("fill-reducing order: METIS failed with status " + std::to_string(status));
    return std::vector<int>(order.begin(), order.end());
}

}  // namespace bullet_fem

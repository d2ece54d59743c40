// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "benchmarks/kernels/compliance_case.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include "bullet_fem/fem/mesh/generators.h"
#include "fem/contact/compliance/compliance_cache.h"
#include "fem/factor/rest_factor.h"

namespace bullet_fem
{
namespace
{

constexpr int kTouched = 64;

std::shared_ptr<const BodyModel> makeBlock(int tets, FactorChoice choice)
{
    const int n = std::max(1, static_cast<int>(std::lround(std::cbrt(tets / 5.0) - 1.0 / 3)));  // five tets per cell
    const auto shape = std::make_shared<const RestShape>(makeBox({1.3, 1.2, 1.2}, {n + 1, n, n}), Material());
    FactorInput input;
    input.m_mass = shape->m_lumpedMass;
    input.m_fixed.assign(input.m_mass.size(), 0);
    input.m_choice = choice;
    return BodyModel::create(shape, std::move(input));
}

/// The surface nodes nearest to a point, in place of nodes in contact.
std::vector<int> nearestSurfaceNodes(const TetMesh& mesh, const Vec3& point)
{
    std::vector<int> nodes = mesh.surfaceNodes();
    const auto distance = [&](int i) { return norm(mesh.restPositions()[i] - point); };
    std::sort(nodes.begin(), nodes.end(),
              [&](int a, int b) { return std::make_pair(distance(a), a) < std::make_pair(distance(b), b); });
    nodes.resize(kTouched);
    return nodes;
}

/// R_i C_ij R_j^T summed over all pairs; the sum keeps the compiler from omitting any.
Mat3 warpedBlocks(const ComplianceCache& cache, const std::vector<int>& nodes, const Mat3& R)
{
    Mat3 sum{};
    for (int i : nodes)
        for (int j : nodes) sum += R * timesTranspose(cache.block(i, j), R);
    return sum;
}

}  // namespace

ComplianceFigures measureCompliance(int tets, FactorChoice choice, double seconds)
{
    const auto model = makeBlock(tets, choice);
    const std::vector<int> nodes = nearestSurfaceNodes(model->mesh(), {0.65, 0.6, 0}),
                           others = nearestSurfaceNodes(model->mesh(), {0.65, 0.6, 1.2});
    const Mat3 R = Mat3::identity();
    Mat3 sum{};
    ComplianceCache known(model);
    known.request(nodes);
    std::unique_ptr<ComplianceCache> fresh;
    const std::vector<TimedWork> work = {{"64 new nodes",
                                          [&]
                                          {
                                              fresh->request(nodes);
                                              sum += warpedBlocks(*fresh, nodes, R);
                                          },
                                          [&]
                                          {
                                              fresh = std::make_unique<ComplianceCache>(model);
                                              fresh->request(others);  // excludes allocations of the first request
                                          }},
                                         {"64 known nodes",
                                          [&]
                                          {
                                              known.request(nodes);
                                              sum += warpedBlocks(known, nodes, R);
                                          },
                                          nullptr}};
    const std::vector<Timing> times = timeInTurns(work, seconds);
    ComplianceFigures figures;
    figures.m_tets = model->mesh().tetCount();
    figures.m_nodes = model->nodeCount();
    figures.m_touched = kTouched;
    figures.m_path = model->factorReport().m_path;
    figures.m_factorMegabytes = 1e-6 * double(model->factorReport().m_bytes);
    figures.m_matrixMegabytes = 1e-6 * double(model->factor().rest().byteCount());
    figures.m_fresh = times[0];
    figures.m_known = times[1];
    return figures;
}

}  // namespace bullet_fem

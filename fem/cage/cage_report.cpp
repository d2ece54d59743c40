// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "bullet_fem/fem/cage/cage_report.h"

#include <cmath>

#include "fem/common/message.h"

namespace bullet_fem
{

double meanRatio(const std::array<Vec3, 4>& corners)
{
    double squares = 0;
    for (int a = 0; a < 4; ++a)
        for (int b = a + 1; b < 4; ++b) squares += dot(corners[b] - corners[a], corners[b] - corners[a]);
    const Vec3 a = corners[1] - corners[0], b = corners[2] - corners[0], c = corners[3] - corners[0];
    const double root = std::cbrt(dot(cross(a, b), c) / 2);  // 3 V
    return squares > 0 ? std::copysign(12 * root * root / squares, root) : 0;
}

std::string describe(const CageReport& report)
{
    std::string text = message(report.m_tets, " tets, ", report.m_nodes, " nodes, cells of ", report.m_cellSize,
                               " m\nmean ratio at least ", report.m_leastQuality, " (bound ", report.m_qualityBound,
                               "), elements by tenths:");
    for (const int count : report.m_qualityHistogram) text += message(' ', count);
    if (report.m_levels > 0)
    {
        text += message("\ngraded, cells of ", report.m_smallestCell, " to ", report.m_largestCell,
                        " m, elements by halvings:");
        for (int level = 0; level <= report.m_levels; ++level) text += message(' ', report.m_levelTets[level]);
    }
    text += message("\nvolume ", report.m_surfaceVolume, " m3 (", report.m_volumeIsExact ? "exact" : "of samples",
                    "), the cage's is ", report.m_volumeRatio, " times that (", report.m_latticeVolumeRatio,
                    " before snapping)\n", report.m_pieces, " pieces, ", report.m_openEdges, " open edges (",
                    100 * report.m_openShare, " %)");
    if (report.m_insideOut) text += ", inside out";
    if (report.m_selfIntersecting) text += ", intersects itself";
    if (report.m_duplicates) text += message(", ", report.m_duplicates, " duplicate triangles left out");
    if (report.m_turned) text += message(", ", report.m_turned, " triangles turned over");
    if (report.m_degenerate) text += message(", ", report.m_degenerate, " triangles without area");
    return text + '\n';
}

}  // namespace bullet_fem

// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include "bullet_fem/fem/cage/cage_report.h"
#include "fem/cage/cage_fill.h"
#include "fem/cage/grading.h"
#include "fem/cage/winding_near.h"

namespace bullet_fem
{

/// The inputs of a graded cage, all relative to the centre of the surface's bounding box.
struct GradingInput
{
    const CageLattice& m_lattice;  ///< marked
    const SurfaceWinding& m_winding;
    const GradedSurface& m_surface;
    bool m_closed;  ///< the winding number is constant away from the triangles
    const CageSettings& m_settings;
    Grading m_grading;
};

/// The non-empty cubes of a lattice, split into tets that are smaller at thin parts of the surface. FilledTet::m_tet is
/// here the index of a tet in the whole lattice.
class GradedLattice
{
public:
    /// Splits until thin parts have the wanted number of cells, or far more than `maxTets` tets exist; see isTooLarge.
    GradedLattice(const GradingInput& input, double maxTets);

    bool isTooLarge() const { return m_tooLarge; }

    /// Approximate number of elements kept: exact if the surface is closed and no vertex needs another element. Stops
    /// counting beyond `most`. Call either this or fill, once.
    double count(double most);

    /// Fills the lattice. Throws std::invalid_argument if more than m_maxTets tets are kept.
    CageFill fill();

    /// Ensures that every used vertex [m] lies in a kept tet, and returns its element in the order of fill.m_tets (0
    /// for unused vertices).
    std::vector<int> holdVertices(const std::vector<Vec3>& vertices, const std::vector<char>& used, CageFill& fill);

    /// The mesh of the kept tets in metres, nodes in ascending order of z, y and x.
    TetMesh mesh(const std::vector<FilledTet>& kept) const;

    /// Writes the sizes of the kept tets to the report.
    void report(const std::vector<FilledTet>& kept, CageReport& report) const;

private:
    enum class State
    {
        outside,
        inside,
        unsure,  // not entered, but near winding number 1/2: must be sampled
        entered
    };
    struct Holder
    {
        int m_tet = -1;
        double m_minWeight = -1e300;
        bool m_kept = false;
    };

    void addCubes();
    void findLeaves(int tet);
    State look(int tet);
    double fractionOf(int tet, State state);
    void findHolder(int tet, const Vec3& p, Holder& best) const;
    double windingAt(const Vec3& p);
    [[noreturn]] void rejectTooMany(double atLeast) const;

    const GradingInput m_input;
    WindingNear m_winding;
    BisectedTets m_tets;
    std::vector<int> m_leaves;  // depth-first, cube by cube
    std::vector<char> m_kept;   // per tet
    std::vector<std::array<double, 4>> m_samples;
    FillTally m_tally;
    double m_sampleCount = 0;
    bool m_tooLarge = false;
};

}  // namespace bullet_fem

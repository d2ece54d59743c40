// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <limits>
#include <string>
#include <vector>

#include "LinearMath/btAlignedObjectArray.h"
#include "LinearMath/btVector3.h"
#include "bullet_fem/btFemPrecision.h"
#include "bullet_fem/fem/common/export.h"

class btFemSoftBodySolver;
class btSoftBody;

// Breaking: a body is cut into pieces, the pieces are welded to each other, and welds break: see docs/materials.md.

/// A part of a body that was cut.
struct btFemPiece
{
    btSoftBody* m_body = nullptr;  ///< the caller's to add to the world and to delete
    int m_label = 0;               ///< of its tetrahedra
    std::vector<int> m_tets;       ///< of the body that was cut, ascending: the piece's are in this order
    std::vector<int> m_nodes;      ///< likewise
};

/// Cuts bodies into pieces.
struct BULLETFEM_API btFemPieces
{
    /// Labels for cut(): every tetrahedron of the body gets the number of the nearest of `cells` points, which
    /// `randomSeed` spreads over the rest shape, the same ones on every machine. `cells` is in [1, number of
    /// tetrahedra]; where they are many, some may be nearest to no tetrahedron. Throws std::invalid_argument (see
    /// btFemSoftBodySolver about `why`) on a number out of range, or a body without usable tetrahedra.
    static bool voronoiLabels(const btSoftBody* body, int cells, unsigned randomSeed, std::vector<int>& labels,
                              std::string* why = nullptr);

    /// Makes a soft body of the tetrahedra of every label, or several where these do not hang together by faces, in the
    /// order of labels. One label a tetrahedron, in the order of m_tetras, such as TetMeshFile::m_regions. The body
    /// stays as it is: take it out of its world. The pieces have its rest shape, positions, velocities, pins, m_cfg,
    /// friction and restitution; what a node weighs is shared out to them by volume, so that mass and momenta stay. An
    /// embedded surface, anchors and what the solver knows (material, targets) are not theirs. Throws
    /// std::invalid_argument on another number of labels, or a body without usable tetrahedra.
    static bool cut(const btSoftBody* body, const std::vector<int>& labels, std::vector<btFemPiece>& pieces,
                    std::string* why = nullptr);
};

/// When a weld breaks, and how stiff it is.
struct BULLETFEM_API btFemWeldStrength
{
    /// Force of all of the weld [N], in (0, inf]: beyond it the weld breaks as a whole.
    btScalar m_breakForce = std::numeric_limits<btScalar>::infinity();
    /// Tension and shear at a node of the weld [Pa], in (0, inf]: beyond it the node tears off. Pressure breaks
    /// nothing.
    btScalar m_breakStress = std::numeric_limits<btScalar>::infinity();
    /// Distance of a node from its partner [m], in (0, inf]: beyond it the node tears off.
    btScalar m_breakStretch = std::numeric_limits<btScalar>::infinity();
    /// Of a layer of glue between the pieces: how far it stretches under a stress [m/Pa], in [0, 1]; 0: it does not.
    btScalar m_compliance = 0;

    /// True if every value is in its range; else `why` (if given) names the value, the range and the remedy.
    bool valid(std::string* why = nullptr) const;
};

/// A weld after the last step.
struct btFemWeldReport
{
    int m_weld = 0;                   ///< its handle
    const btSoftBody* m_a = nullptr;  ///< that has it
    const btSoftBody* m_b = nullptr;  ///< that it is welded to
    int m_nodes = 0;                  ///< that are tied, > 0
    btScalar m_area = 0;              ///< that they hold, as it was when they were welded [m2]
    btVector3 m_force{0, 0, 0};       ///< on m_a [N]
    btScalar m_stress = 0;            ///< largest tension and shear at a node [Pa], >= 0
    btScalar m_stretch = 0;           ///< largest distance of a node from its partner as the step began [m], >= 0
};

/// A weld that broke, or some of its nodes.
struct btFemWeldBreak
{
    int m_weld = 0;                   ///< its handle
    const btSoftBody* m_a = nullptr;  ///< that has it; may be deleted since: compare it, never follow it
    const btSoftBody* m_b = nullptr;  ///< likewise, that it was welded to
    int m_broken = 0;                 ///< nodes that tore off
    int m_left = 0;                   ///< nodes that are still tied; 0: the two are apart
    btVector3 m_force{0, 0, 0};       ///< of the weld on m_a, in the step that was too much [N]
    btScalar m_stress = 0;            ///< likewise the largest at a node [Pa]
    btScalar m_stretch = 0;           ///< likewise [m]
    btScalar m_time = 0;              ///< at the end of that step, since the solver's first [s]
};

/// Welds FEM bodies by the faces that they have in common. Every node of these faces is tied to its partner, as by
/// btFemSoftBodySolver::attachNodes; bodies that hang together by welds touch each other only if
/// they have CL_SELF. Impulses of a weld are those
/// of a step: an impact is spread over it. btFemSoftBodySolver::detach(a, weld) takes a weld apart, saveState() saves
/// welds, anchors() shows every tied node.
struct BULLETFEM_API btFemWelds
{
    /// Welds two bodies as they lie, until the weld breaks, one of them leaves the world or its mesh changes. Corners
    /// of common faces are at most `reach` [m] apart, in (0, 1e3]; 0: a thousandth of the shorter mean edge. Returns a
    /// handle of `a`, > 0. Throws std::invalid_argument on a body that is not FEM (prepare() it), the same body twice,
    /// no common face, bodies that are welded already, or if !strength.valid().
    static int weld(btFemSoftBodySolver& solver, btSoftBody* a, btSoftBody* b, const btFemWeldStrength& strength,
                    btScalar reach = 0, std::string* why = nullptr);

    /// Welds all pieces that have common faces. Returns how many welds that are. Throws likewise, before anything is
    /// welded, but where pieces have no common face.
    static int weldPieces(btFemSoftBodySolver& solver, const std::vector<btFemPiece>& pieces,
                          const btFemWeldStrength& strength, std::string* why = nullptr);

    /// The welds that a body has as `a`, in the order in which they were made. False, and an empty array, if it is not
    /// FEM. Allocates only when an array grows.
    static bool welds(const btFemSoftBodySolver& solver, const btSoftBody* body,
                      btAlignedObjectArray<btFemWeldReport>& reports);

    /// What broke since clearBreaks(), in the order of time. Valid until the next step.
    static const btAlignedObjectArray<btFemWeldBreak>& breaks(const btFemSoftBodySolver& solver);
    /// Forgets them, as restoreState() does.
    static void clearBreaks(btFemSoftBodySolver& solver);
};

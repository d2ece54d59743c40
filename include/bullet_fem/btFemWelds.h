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

// Breaking: a body is cut into fragments, the fragments are welded to each other, and welds break (docs/materials.md).

/// A fragment of a cut body.
struct btFemPiece
{
    btSoftBody* m_body = nullptr;  ///< owned by the caller, who adds it to the world and deletes it
    int m_label = 0;               ///< label of its tetrahedra
    std::vector<int> m_tets;       ///< its tetrahedra in the cut body, ascending; the fragment has them in this order
    std::vector<int> m_nodes;      ///< its nodes in the cut body, ascending; the fragment has them in this order
};

/// Cuts bodies into fragments.
struct BULLETFEM_API btFemPieces
{
    /// Labels for cut(): every tetrahedron gets the index of the nearest of `cells` random points, which are
    /// distributed over the rest shape by `randomSeed`, equally on every machine. `cells` is in [1, number of
    /// tetrahedra]; if it is large, some points may have no tetrahedron. Tetrahedra that are not connected to the
    /// largest component of their label take the label of a neighbour. Throws std::invalid_argument (see
    /// btFemSoftBodySolver about `why`) on a number out of range, or a body without usable tetrahedra. Allocates.
    static bool voronoiLabels(const btSoftBody* body, int cells, unsigned randomSeed, std::vector<int>& labels,
                              std::string* why = nullptr);

    /// Makes a soft body of the tetrahedra of every label, or several if these are not connected by faces, in ascending
    /// order of labels. `labels`: one per tetrahedron, in the order of m_tetras, such as TetMeshFile::m_regions. The
    /// body itself is unchanged: remove it from its world. Fragments get its rest shape, positions, velocities, pins,
    /// m_cfg, friction and restitution; node masses are divided by volume, so that mass and momenta are conserved. They
    /// do not get an embedded surface, anchors, or settings of the solver (material, targets). Throws
    /// std::invalid_argument on another number of labels, or a body without usable tetrahedra. Allocates.
    static bool cut(const btSoftBody* body, const std::vector<int>& labels, std::vector<btFemPiece>& pieces,
                    std::string* why = nullptr);
};

/// Strength and stiffness of a weld.
struct BULLETFEM_API btFemWeldStrength
{
    /// Total force on the weld [N], in (0, inf], beyond which the weld breaks as a whole.
    btScalar m_breakForce = std::numeric_limits<btScalar>::infinity();
    /// Stress of tension and shear at a node of the weld [Pa], in (0, inf], beyond which the node detaches. Pressure
    /// breaks nothing.
    btScalar m_breakStress = std::numeric_limits<btScalar>::infinity();
    /// Distance of a node from its partner [m], in (0, inf], beyond which the node detaches.
    btScalar m_breakStretch = std::numeric_limits<btScalar>::infinity();
    /// Compliance of a layer of glue between the fragments: its stretch per stress [m/Pa], in [0, 1]; 0: rigid.
    btScalar m_compliance = 0;

    /// True if every value is in its range; else `why` (if given) names the value, the range and the remedy.
    bool valid(std::string* why = nullptr) const;
};

/// State of a weld after the last step.
struct btFemWeldReport
{
    int m_weld = 0;                   ///< handle of the weld
    const btSoftBody* m_a = nullptr;  ///< body that owns the weld
    const btSoftBody* m_b = nullptr;  ///< body that it is welded to
    int m_nodes = 0;                  ///< number of tied nodes, > 0
    btScalar m_area = 0;              ///< area of the tied nodes at the time of welding [m2]
    btVector3 m_force{0, 0, 0};       ///< force on m_a [N]
    btScalar m_stress = 0;            ///< largest stress of tension and shear at a node [Pa], >= 0
    btScalar m_stretch = 0;  ///< largest distance of a node from its partner at the beginning of the step [m], >= 0
};

/// A weld that broke as a whole or in part.
struct btFemWeldBreak
{
    int m_weld = 0;  ///< handle of the weld
    /// Body that owns the weld; may be deleted by now: compare the pointer, never dereference it.
    const btSoftBody* m_a = nullptr;
    /// Body that it was welded to; may be deleted by now: compare the pointer, never dereference it.
    const btSoftBody* m_b = nullptr;
    int m_broken = 0;            ///< number of nodes that detached
    int m_left = 0;              ///< number of nodes still tied; 0: the bodies are separate
    btVector3 m_force{0, 0, 0};  ///< force of the weld on m_a in the step in which it broke [N]
    btScalar m_stress = 0;       ///< largest stress at a node in that step [Pa]
    btScalar m_stretch = 0;      ///< largest distance of a node from its partner in that step [m]
    btScalar m_time = 0;         ///< time at the end of that step, since the solver's first step [s]
};

/// Welds FEM bodies at their common faces. Every node of these faces is tied to its partner, as by
/// btFemSoftBodySolver::attachNodes. Bodies connected by welds collide with each other only if they have CL_SELF. Weld
/// forces are impulses of a step over h: an impact is averaged over the step. btFemSoftBodySolver::detach(a, weld)
/// removes a weld, saveState() saves welds, anchors() lists every tied node. Functions with a last argument `why`
/// follow btFemSoftBodySolver.
struct BULLETFEM_API btFemWelds
{
    /// Welds two bodies in their present positions, until the weld breaks, one of them leaves the world or its mesh
    /// changes. Corners of common faces are at most `reach` [m] apart, in (0, 1e3]; 0: a thousandth of the shorter mean
    /// edge. Returns a handle of `a`, > 0. Throws std::invalid_argument on a body that is not FEM (prepare() it), two
    /// equal bodies, no common face, bodies that are welded already, or if !strength.valid().
    static int weld(btFemSoftBodySolver& solver, btSoftBody* a, btSoftBody* b, const btFemWeldStrength& strength,
                    btScalar reach = 0, std::string* why = nullptr);

    /// Welds all fragments that have common faces, with `reach` 0. Returns the number of welds. Throws
    /// std::invalid_argument, before anything is welded, where weld() does, except for fragments without common faces,
    /// which are skipped.
    static int weldPieces(btFemSoftBodySolver& solver, const std::vector<btFemPiece>& pieces,
                          const btFemWeldStrength& strength, std::string* why = nullptr);

    /// The welds that the body owns (as `a`), in the order of their creation. Returns false and an empty array if it is
    /// not FEM. Allocates only when an array grows.
    static bool welds(const btFemSoftBodySolver& solver, const btSoftBody* body,
                      btAlignedObjectArray<btFemWeldReport>& reports);

    /// Breaks since clearBreaks(), in chronological order. Valid until the next step.
    static const btAlignedObjectArray<btFemWeldBreak>& breaks(const btFemSoftBodySolver& solver);
    /// Clears the list of breaks, as restoreState() does.
    static void clearBreaks(btFemSoftBodySolver& solver);
};

// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <string>
#include <vector>

#include "LinearMath/btAlignedObjectArray.h"
#include "LinearMath/btVector3.h"
#include "bullet_fem/btFemPrecision.h"
#include "bullet_fem/fem/common/export.h"

class btFemSoftBodySolver;
class btSoftBody;

// Fracture: a body splits along the faces of its elements where tension exceeds its strength (docs/materials.md).

/// Strength of a body against splitting.
struct BULLETFEM_API btFemTensileStrength
{
    /// Tensile strength [Pa], in (0, 1e13].
    btScalar m_tension = 0;
    /// Maximum number of cracks that begin or grow in a step, in [1, 1000]: one for tearing, more for shattering. The
    /// largest tension comes first.
    int m_mostCracks = 1;
    /// Once the body has fallen into several connected components, these collide with each other: CL_SELF is set in
    /// m_cfg.collisions.
    bool m_partsTouch = true;

    /// True if every value is in its range; else `why` (if given) names the value, the range and the remedy.
    bool valid(std::string* why = nullptr) const;
};

/// A body that split at the end of a step.
struct btFemSplit
{
    const btSoftBody* m_body = nullptr;  ///< body; may be deleted by now: compare the pointer, never dereference it
    int m_cracks = 0;                    ///< number of cracks that began or grew, > 0
    int m_faces = 0;                     ///< number of element faces that separated, > 0
    btScalar m_area = 0;                 ///< area of these faces [m2], > 0
    btVector3 m_place{0, 0, 0};          ///< point of the largest tension [m]
    btVector3 m_normal{0, 0, 0};         ///< direction of the largest tension, a unit vector
    btScalar m_stress = 0;               ///< largest tension [Pa]
    int m_parts = 0;                     ///< connected components of the body now, >= 1
    int m_firstNode = 0;                 ///< index of the first new node in m_nodes; new nodes are last
    std::vector<int> m_copyOf;           ///< for every new node in turn: the node that it was copied from
    int m_firstFace = 0;                 ///< index of the first new face in m_faces; new faces are last
    btScalar m_time = 0;                 ///< time at the end of that step, since the solver's first step [s]
};

/// Lets FEM bodies split along the faces of their elements. Splitting is the last operation of a step: nodes on crack
/// faces are copied, with equal position and velocity, and m_faces gains both crack faces; new nodes and faces follow
/// the existing ones. The mass of a node is divided by volume, so mass and momenta are conserved. The body remains one
/// btSoftBody with any number of connected components; btFemPieces::cut with equal labels makes separate bodies of
/// these. Pointers to nodes and faces that a program keeps become invalid, as after appendNode; Bullet's links, anchors
/// and tetrahedra stay valid. Pins, targets, attachments, welds, fibres and expansions are kept (pins and targets also
/// hold copies); cables and chambers are lost.
struct BULLETFEM_API btFemFracture
{
    /// Sets the strength of a body, which is kept when its mesh changes. Throws std::invalid_argument (see
    /// btFemSoftBodySolver about `why`) if !strength.valid(), or on a body that is not FEM (prepare() it) or has an
    /// embedded surface.
    static bool setStrength(btFemSoftBodySolver& solver, btSoftBody* body, const btFemTensileStrength& strength,
                            std::string* why = nullptr);
    /// Removes the strength of a body, which then never splits; without effect on a body without strength.
    static void clearStrength(btFemSoftBodySolver& solver, btSoftBody* body);

    /// Splits since clearSplits(), in chronological order. Valid until the next step.
    static const btAlignedObjectArray<btFemSplit>& splits(const btFemSoftBodySolver& solver);
    /// Clears the list of splits, as restoreState() does.
    static void clearSplits(btFemSoftBodySolver& solver);
};

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

// Splitting: a body tears along the faces of its elements where tension is beyond its strength: see docs/materials.md.

/// When a body splits.
struct BULLETFEM_API btFemTensileStrength
{
    /// Tension that the material bears [Pa], in (0, 1e13].
    btScalar m_tension = 0;
    /// Cracks that begin or go on in a step, in [1, 1000]: one for what tears, more for what shatters. The largest
    /// tension comes first.
    int m_mostCracks = 1;
    /// Once the body has fallen into parts these touch each other: CL_SELF is switched on in m_cfg.collisions.
    bool m_partsTouch = true;

    /// True if every value is in its range; else `why` (if given) names the value, the range and the remedy.
    bool valid(std::string* why = nullptr) const;
};

/// A body that has split as a step ended.
struct btFemSplit
{
    const btSoftBody* m_body = nullptr;  ///< may be deleted since: compare it, never follow it
    int m_cracks = 0;                    ///< that began or went on, > 0
    int m_faces = 0;                     ///< between elements that have parted, > 0
    btScalar m_area = 0;                 ///< of these faces [m2], > 0
    btVector3 m_place{0, 0, 0};          ///< where the tension was largest [m]
    btVector3 m_normal{0, 0, 0};         ///< its direction there, a unit vector
    btScalar m_stress = 0;               ///< and how large it was [Pa]
    int m_parts = 0;                     ///< that the body hangs together in now, >= 1
    int m_firstNode = 0;                 ///< of the new ones in m_nodes, which are the last
    std::vector<int> m_copyOf;           ///< of every new node in turn: the node that it was split from
    int m_firstFace = 0;                 ///< of the new ones in m_faces, which are the last
    btScalar m_time = 0;                 ///< at the end of that step, since the solver's first [s]
};

/// Lets FEM bodies split along the faces of their elements. It happens as a step ends, after all else: nodes around
/// which elements have parted get copies at the same place and with the same velocity, m_faces the sides of the crack,
/// both after those that are there. What nodes weighed is shared out by volume, so that mass and momenta stay. The body
/// remains one btSoftBody, in however many parts; btFemPieces::cut with equal labels makes bodies of these. Pointers to
/// nodes and faces that a program keeps are invalid then, as after appendNode; Bullet's links, anchors and tetrahedra
/// are not. Pins, targets, attachments, welds, fibres and expansions stay (pins and targets hold copies too), cables
/// and chambers are lost.
struct BULLETFEM_API btFemFracture
{
    /// Gives a body a strength, now and when its mesh changes. Throws std::invalid_argument (see btFemSoftBodySolver
    /// about `why`) if !strength.valid(), or on a body that is not FEM (prepare() it) or has an embedded surface.
    static bool setStrength(btFemSoftBodySolver& solver, btSoftBody* body, const btFemTensileStrength& strength,
                            std::string* why = nullptr);
    /// The body splits no more; nothing if it does not.
    static void clearStrength(btFemSoftBodySolver& solver, btSoftBody* body);

    /// What split since clearSplits(), in the order of time. Valid until the next step.
    static const btAlignedObjectArray<btFemSplit>& splits(const btFemSoftBodySolver& solver);
    /// Forgets them, as restoreState() does.
    static void clearSplits(btFemSoftBodySolver& solver);
};

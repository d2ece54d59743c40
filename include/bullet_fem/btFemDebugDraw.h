// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <string>

#include "LinearMath/btVector3.h"
#include "bullet_fem/fem/common/export.h"

class btFemSoftBodySolver;
class btIDebugDraw;
class btSoftBody;

/// What btFemDebugDraw draws of a body; any sum of them.
enum btFemDrawModes
{
    BT_FEM_DRAW_ELEMENTS = 1 << 0,     ///< the six edges of every tetrahedron
    BT_FEM_DRAW_STRESS_FREE = 1 << 1,  ///< the surface of the rest shape, where it fits the body best without strain
    /// The points of contacts() as crosses, their normals, and their impulses on the body as arrows.
    BT_FEM_DRAW_CONTACTS = 1 << 2
};

/// How it is drawn.
struct BULLETFEM_API btFemDrawSettings
{
    btScalar m_shrink = btScalar(0.9);        ///< size of drawn elements about their middle [-], in (0, 1]
    btScalar m_pointSize = btScalar(0.02);    ///< half the length of a cross [m], >= 0
    btScalar m_normalLength = btScalar(0.1);  ///< [m], >= 0; 0: no normals
    btScalar m_impulseScale = btScalar(0.1);  ///< length of an arrow by its impulse [m per N s], >= 0; 0: no arrows
    btVector3 m_elementColor =
        btVector3(btScalar(0.4), btScalar(0.6), 1);  ///< of elements: red, green and blue [-], in [0, 1]
    btVector3 m_restColor = btVector3(btScalar(0.2), btScalar(0.8),
                                      btScalar(0.2));  ///< of the stress-free shape: red, green and blue [-], in [0, 1]
    btVector3 m_pointColor = btVector3(1, 0, 0);       ///< of contact points: red, green and blue [-], in [0, 1]
    btVector3 m_normalColor = btVector3(1, 1, 0);      ///< of normals: red, green and blue [-], in [0, 1]
    btVector3 m_impulseColor = btVector3(1, btScalar(0.5), 0);  ///< of impulses: red, green and blue [-], in [0, 1]

    /// True if every value is in its range; else `why` (if given) names the value, the range and the remedy.
    bool valid(std::string* why = nullptr) const;
};

/// Draws FEM bodies through Bullet's btIDebugDraw, besides what world.debugDrawWorld and btSoftBodyHelpers::Draw draw
/// of them as of all soft bodies. Between steps; changes nothing, allocates nothing.
struct BULLETFEM_API btFemDebugDraw
{
    /// Draws modes (btFemDrawModes) of a body; nothing if it is not FEM, or the drawer is null. Throws
    /// std::invalid_argument if !settings.valid().
    /// With `why`, for engines without exceptions: false and the reason there instead.
    static bool draw(const btFemSoftBodySolver& fem, const btSoftBody* body, btIDebugDraw* drawer, int modes,
                     const btFemDrawSettings& settings = btFemDrawSettings(), std::string* why = nullptr);
};

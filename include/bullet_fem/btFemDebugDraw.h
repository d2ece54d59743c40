// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <string>

#include "LinearMath/btVector3.h"
#include "bullet_fem/fem/common/export.h"

class btFemSoftBodySolver;
class btIDebugDraw;
class btSoftBody;

/// Drawing modes of btFemDebugDraw; may be combined by bitwise or.
enum btFemDrawModes
{
    BT_FEM_DRAW_ELEMENTS = 1 << 0,     ///< the six edges of every tetrahedron
    BT_FEM_DRAW_STRESS_FREE = 1 << 1,  ///< the surface of the rest shape, in its best rigid fit to the body
    /// The points of contacts() as crosses, with their normals and the impulses on the body as arrows.
    BT_FEM_DRAW_CONTACTS = 1 << 2
};

/// Sizes and colours for btFemDebugDraw.
struct BULLETFEM_API btFemDrawSettings
{
    btScalar m_shrink = btScalar(0.9);        ///< scale of drawn elements about their centroid [-], in (0, 1]
    btScalar m_pointSize = btScalar(0.02);    ///< half the length of a cross [m], >= 0
    btScalar m_normalLength = btScalar(0.1);  ///< length of normals [m], >= 0; 0: no normals
    btScalar m_impulseScale = btScalar(0.1);  ///< arrow length per impulse [m/(N s)], >= 0; 0: no arrows
    /// Colour of elements: red, green and blue [-], in [0, 1].
    btVector3 m_elementColor = btVector3(btScalar(0.4), btScalar(0.6), 1);
    btVector3 m_restColor = btVector3(btScalar(0.2), btScalar(0.8),
                                      /// colour of the stress-free shape: red, green and blue [-], in [0, 1]
                                      btScalar(0.2));
    btVector3 m_pointColor = btVector3(1, 0, 0);   ///< colour of contact points: red, green and blue [-], in [0, 1]
    btVector3 m_normalColor = btVector3(1, 1, 0);  ///< colour of normals: red, green and blue [-], in [0, 1]
    /// colour of impulses: red, green and blue [-], in [0, 1]
    btVector3 m_impulseColor = btVector3(1, btScalar(0.5), 0);

    /// True if every value is in its range; else `why` (if given) names the value, the range and the remedy.
    bool valid(std::string* why = nullptr) const;
};

/// Draws FEM bodies through Bullet's btIDebugDraw, in addition to world.debugDrawWorld and btSoftBodyHelpers::Draw,
/// which draw them as any soft body. To be called between steps; changes nothing, allocates nothing.
struct BULLETFEM_API btFemDebugDraw
{
    /// Draws a body in the given modes (btFemDrawModes); nothing if it is not FEM or the drawer is null. Throws
    /// std::invalid_argument if !settings.valid(); with `why`, for engines without exceptions, returns false and writes
    /// the reason there instead.
    static bool draw(const btFemSoftBodySolver& fem, const btSoftBody* body, btIDebugDraw* drawer, int modes,
                     const btFemDrawSettings& settings = btFemDrawSettings(), std::string* why = nullptr);
};

// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <string>

#include "LinearMath/btAlignedObjectArray.h"
#include "LinearMath/btVector3.h"
#include "bullet_fem/btFemCollision.h"
#include "bullet_fem/btFemPrecision.h"
#include "bullet_fem/fem/cage/cage.h"
#include "bullet_fem/fem/common/export.h"

class btDiscreteDynamicsWorld;
class btSoftBody;
struct btFemMaterial;
struct btSoftBodyWorldInfo;

namespace bullet_fem
{
struct BakedBody;  // bullet_fem/fem/baked/baked_body.h
}

/// Makes tetrahedral soft bodies. All have water's density (1000 kg/m3) until setMaterial says otherwise, outward
/// boundary faces for collision and drawing, no links; the caller owns them. All throw std::invalid_argument
/// (std::runtime_error for files) naming value, range and remedy.
struct BULLETFEM_API btFemHelpers
{
    /// A cage of lattice cells of `cellSize` [m] around the closed surface of an OFF, OBJ, STL or PLY file, which
    /// follows the cage as m_renderNodes and m_renderFaces. What collides is the cage's surface, up to a cell outside
    /// the file's, unless BT_FEM_RENDER_SURFACE is put into m_cfg.collisions. `scale` [-], > 0, multiplies the file's
    /// positions.
    static btSoftBody* createFromSurfaceFile(btSoftBodyWorldInfo& worldInfo, const char* path, btScalar cellSize,
                                             btScalar scale = btScalar(1), std::string* why = nullptr);

    /// The same from a surface in memory.
    static btSoftBody* createFromSurface(btSoftBodyWorldInfo& worldInfo, const bullet_fem::SurfaceMesh& surface,
                                         const bullet_fem::CageSettings& settings, std::string* why = nullptr);

    /// The same, with a report on the cage and on what was found in the surface.
    static btSoftBody* createFromSurface(btSoftBodyWorldInfo& worldInfo, const bullet_fem::SurfaceMesh& surface,
                                         const bullet_fem::CageSettings& settings, bullet_fem::CageReport& report,
                                         std::string* why = nullptr);

    /// As the first `<deformable>` of a URDF file says, which is how pybullet loads soft bodies: mesh of tetrahedra,
    /// mass, friction, margin, gravity factor, and the surface to draw as m_renderNodes. `material` takes Young's
    /// modulus, Poisson's ratio and damping from the file, if it gives moduli, and density 0, so that the mass stays
    /// the file's: hand it to setMaterial. `scale` [-], > 0, multiplies positions. Place it with translate and rotate.
    static btSoftBody* createFromUrdf(btSoftBodyWorldInfo& worldInfo, const char* path, btFemMaterial& material,
                                      btScalar scale = btScalar(1), std::string* why = nullptr);

    /// From a tetrahedral mesh, in the order of its nodes and elements.
    static btSoftBody* createFromTetMesh(btSoftBodyWorldInfo& worldInfo, const bullet_fem::TetMesh& mesh,
                                         std::string* why = nullptr);

    /// From `nodeCount` positions [m] and 4 `tetCount` node indices, in the given order. Elements of negative
    /// orientation are turned.
    static btSoftBody* createFromTetMesh(btSoftBodyWorldInfo& worldInfo, const btVector3* positions, int nodeCount,
                                         const int* tets, int tetCount, std::string* why = nullptr);

    /// A box around `center` with half extents [m], each > 0, of about `cellSize` [m] cells.
    static btSoftBody* createBox(btSoftBodyWorldInfo& worldInfo, const btVector3& center, const btVector3& halfExtents,
                                 btScalar cellSize, std::string* why = nullptr);

    /// From a baked body, where it was baked, with its masses, pins and embedded surface. It does not keep the factor:
    /// give both to btFemSoftBodySolver::useBaked.
    static btSoftBody* createFromBaked(btSoftBodyWorldInfo& worldInfo, const bullet_fem::BakedBody& baked,
                                       std::string* why = nullptr);

    /// Moves m_renderNodes with the body, as Bullet's interpolateBarycentricWeights or extrapolateBarycentricWeights
    /// have tied them to it; nothing if weights or parents are missing. The solver does so after every step, and
    /// Bullet's transform, translate, rotate and scale do not: call this after them to draw the body before the next
    /// one.
    static void updateEmbeddedSurface(btSoftBody* body);

    /// The time for which the world shows its rigid bodies in their motion states, in steps from the end of its last
    /// one [-], in [-1, 1]: for interpolateNodes(). Between steps of a fixed length that is m_localTime / step - 1, or
    /// without the latter where setLatencyMotionStateInterpolation(false) was called. Without a fixed length
    /// (stepSimulation(dt, 0)) it is 0, or 1 after that call, because Bullet then shows rigid bodies a step ahead.
    static btScalar interpolationFraction(const btDiscreteDynamicsWorld& world);

    /// Positions of the nodes [m] to draw between two steps, in the order of m_nodes, where Bullet's motion states have
    /// the rigid bodies. `fraction` is the time in steps from the end of the last step [-], in [-1, 1]. From -1 (its
    /// begin) to 0 (its end) the nodes go along straight lines from m_q to m_x, above 0 from m_x on with m_v for that
    /// share of the body's last step. Values outside count as the nearest bound, NaN as 0. A body that sleeps, is in no
    /// world, or was never stepped stands at m_x. Cloth and ropes are interpolated in the same way. False, and an empty
    /// array, on null. Allocates only when the array grows.
    static bool interpolateNodes(const btSoftBody* body, btScalar fraction, btAlignedObjectArray<btVector3>& out);

    /// The same for m_renderNodes, which follow the nodes. Vertices stand where m_renderNodes has them if weights or
    /// parents are missing. False, and an empty array, on null or a body without an embedded surface.
    static bool interpolateEmbeddedSurface(const btSoftBody* body, btScalar fraction,
                                           btAlignedObjectArray<btVector3>& out);
};

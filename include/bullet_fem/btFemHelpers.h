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

/// Makes tetrahedral soft bodies with water's density (1000 kg/m3) until setMaterial sets another, outward boundary
/// faces for collision and drawing, and no links. The caller owns them. All functions allocate, and throw
/// std::invalid_argument (std::runtime_error for files) naming value, range and remedy; with `why`, for engines without
/// exceptions, they return null and write the message there.
struct BULLETFEM_API btFemHelpers
{
    /// A body from a surface file: a cage of lattice cells of `cellSize` [m] around the closed surface of an OFF, OBJ,
    /// STL or PLY file, which is embedded as m_renderNodes and m_renderFaces. The collision surface is the cage's
    /// boundary, up to a cell outside the file's surface, unless BT_FEM_RENDER_SURFACE is set in m_cfg.collisions.
    /// `scale` [-], > 0, multiplies the file's positions.
    static btSoftBody* createFromSurfaceFile(btSoftBodyWorldInfo& worldInfo, const char* path, btScalar cellSize,
                                             btScalar scale = btScalar(1), std::string* why = nullptr);

    /// A body from a surface in memory [m]: a cage with the given settings (makeCage), in which the surface is embedded
    /// as m_renderNodes and m_renderFaces.
    static btSoftBody* createFromSurface(btSoftBodyWorldInfo& worldInfo, const bullet_fem::SurfaceMesh& surface,
                                         const bullet_fem::CageSettings& settings, std::string* why = nullptr);

    /// A body from a surface in memory, as the overload above, which also writes statistics of the cage and of its
    /// surface to `report`.
    static btSoftBody* createFromSurface(btSoftBodyWorldInfo& worldInfo, const bullet_fem::SurfaceMesh& surface,
                                         const bullet_fem::CageSettings& settings, bullet_fem::CageReport& report,
                                         std::string* why = nullptr);

    /// A body from the first `<deformable>` of a URDF file, as pybullet loads soft bodies: tetrahedral mesh, mass,
    /// friction, margin, gravity factor, and the surface to draw as m_renderNodes. `material` gets density 0, which
    /// keeps the file's mass, and, if the file gives moduli, their Young's modulus and Poisson's ratio and the file's
    /// damping; pass it to setMaterial. `scale` [-], > 0, multiplies positions. The body stands in the file's
    /// coordinates; place it with translate and rotate.
    static btSoftBody* createFromUrdf(btSoftBodyWorldInfo& worldInfo, const char* path, btFemMaterial& material,
                                      btScalar scale = btScalar(1), std::string* why = nullptr);

    /// A body from a tetrahedral mesh, with nodes and elements in its order.
    static btSoftBody* createFromTetMesh(btSoftBodyWorldInfo& worldInfo, const bullet_fem::TetMesh& mesh,
                                         std::string* why = nullptr);

    /// A body from `nodeCount` positions [m] and 4 `tetCount` node indices, in the given order. Elements of negative
    /// orientation are reversed.
    static btSoftBody* createFromTetMesh(btSoftBodyWorldInfo& worldInfo, const btVector3* positions, int nodeCount,
                                         const int* tets, int tetCount, std::string* why = nullptr);

    /// A box around `center` [m] with half extents [m], each > 0, and cells of about `cellSize` [m], > 0.
    static btSoftBody* createBox(btSoftBodyWorldInfo& worldInfo, const btVector3& center, const btVector3& halfExtents,
                                 btScalar cellSize, std::string* why = nullptr);

    /// A body from a baked body, at the baked positions, with its masses, pins and embedded surface. The body does not
    /// keep the factor: pass both to btFemSoftBodySolver::useBaked.
    static btSoftBody* createFromBaked(btSoftBodyWorldInfo& worldInfo, const bullet_fem::BakedBody& baked,
                                       std::string* why = nullptr);

    /// Moves m_renderNodes with the body by the weights of Bullet's interpolateBarycentricWeights or
    /// extrapolateBarycentricWeights; without effect if weights or parents are missing. The solver calls it after every
    /// step, but Bullet's transform, translate, rotate and scale do not: call it after them to draw the body before the
    /// next step.
    static void updateEmbeddedSurface(btSoftBody* body);

    /// The time at which the world's motion states show its rigid bodies, in steps relative to the end of the last step
    /// [-], in [-1, 1]: for interpolateNodes(). Between steps of fixed length it is m_localTime / step - 1, or
    /// m_localTime / step after setLatencyMotionStateInterpolation(false). Without a fixed length (stepSimulation(dt,
    /// 0)) it is 0, or 1 after that call, because Bullet then shows rigid bodies a step ahead.
    static btScalar interpolationFraction(const btDiscreteDynamicsWorld& world);

    /// Node positions to draw between two steps [m], in the order of m_nodes, at the time at which Bullet's motion
    /// states show the rigid bodies. `fraction` is that time in steps relative to the end of the last step [-], in [-1,
    /// 1]: from -1 (beginning of the step) to 0 (its end), positions are interpolated linearly from m_q to m_x; above 0
    /// they are extrapolated from m_x with m_v for that share of the body's last step. Values outside are clamped, NaN
    /// counts as 0. A body that sleeps, is in no world, or was never stepped gives m_x. Cloth and ropes are
    /// interpolated as well. Returns false and an empty array on null. Allocates only when the array grows.
    static bool interpolateNodes(const btSoftBody* body, btScalar fraction, btAlignedObjectArray<btVector3>& out);

    /// Vertex positions of the embedded surface to draw between two steps [m], in the order of m_renderNodes: embedded
    /// in the positions of interpolateNodes() for `fraction` [-], in [-1, 1]. The present m_renderNodes if weights or
    /// parents are missing. Returns false and an empty array on null or for a body without an embedded surface.
    /// Allocates only when the array grows.
    static bool interpolateEmbeddedSurface(const btSoftBody* body, btScalar fraction,
                                           btAlignedObjectArray<btVector3>& out);
};

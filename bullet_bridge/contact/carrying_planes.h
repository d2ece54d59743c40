// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <vector>

#include "bullet_bridge/geometry/shapes/swept_distance.h"

namespace bullet_fem
{

/// A flat face of a moving object that slides on soft bodies.
struct CarryingPlane
{
    bool m_exists = false;
    Vec3 m_normal;          ///< unit, out of the object
    double m_distance = 0;  ///< of the plane from the origin, along the normal, as the step begins [m]
};

/// The soft bodies that carry an object on one side.
struct CarryingSide
{
    bool m_exists = false;
    Vec3 m_normal;    ///< unit, out of the object: mean of the impulses
    Vec3 m_velocity;  ///< of the soft bodies there, weighted by impulse [m/s]
};

constexpr double kSunk = 0.2;  ///< depth to which objects sink into soft bodies that carry them, over the mean edge [-]

/// Finds the planes by which objects lay on soft bodies in the last step. Scratch grows, never shrinks.
class CarryingPlanes
{
public:
    /// `oneFaceCosine`: smallest cosine of the normals of contacts with one flat face [-].
    explicit CarryingPlanes(double oneFaceCosine);

    /// A contact of an object in the last step.
    struct Push
    {
        int m_objectId;
        double m_size;         ///< normal impulse [N s], > 0
        Vec3 m_normal;         ///< unit, out of the object
        Vec3 m_foot;           ///< point on the object [m]
        Vec3 m_velocity = {};  ///< present one of the soft body that gives it [m/s]; for sideOf
    };

    void clear() { m_pushes.clear(); }
    void add(const Push& push) { m_pushes.push_back(push); }

    /// Call after the last add().
    void find();

    /// The plane of an object that has moved for `step` [s] since, if one face carries it; `motion` has its present
    /// centre.
    CarryingPlane planeOf(int objectId, const RigidMotion& motion, double step) const;

    /// The side on which soft bodies carry an object, if they press little on others.
    CarryingSide sideOf(int objectId) const;

private:
    struct Carried
    {
        int m_objectId;
        CarryingPlane m_plane;
        Vec3 m_foot;  // mean of the points on the plane [m]
        CarryingSide m_side;
    };

    const Carried* find(int objectId) const;
    CarryingSide sideOf(std::size_t first, std::size_t end) const;

    void findPlane(std::size_t first, std::size_t end, Carried& carried) const;

    double m_oneFaceCosine;
    std::vector<Push> m_pushes;
    std::vector<int> m_order;        // scratch
    std::vector<Carried> m_carried;  // by object, ascending
};

}  // namespace bullet_fem

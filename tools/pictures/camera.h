// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include "bullet_fem/fem/common/vec3.h"

namespace bullet_fem
{

/// Normalised vector; `a` must not be 0.
Vec3 unit(const Vec3& a);

/// Size of a picture.
struct PictureSize
{
    int m_width = 1280, m_height = 720;  ///< [pixels], > 0
};

/// A perspective camera.
struct PictureCamera
{
    Vec3 m_eye{2, 1.2, 3}, m_target, m_up{0, 1, 0};  ///< [m]; eye and target differ, up is not along the view
    double m_fieldOfView = 0.6;                      ///< vertical [rad], in (0, 3)
};

/// Orthonormal axes of the camera.
struct CameraAxes
{
    Vec3 m_right, m_up, m_back;
};
CameraAxes axes(const PictureCamera& camera);

/// A point in a picture [pixels] from the upper left corner; pixel (i, j) has its centre at (i + 0.5, j + 0.5).
struct PicturePoint
{
    double m_x = 0, m_y = 0;
};

/// Projects `point`, which must be in front of the camera, into the picture.
PicturePoint projected(const PictureCamera& camera, const PictureSize& size, const Vec3& point);

/// A ray from the camera into the scene [m].
struct PictureRay
{
    Vec3 m_from, m_to;
};

/// The ray from the eye through `point`, `length` [m] long.
PictureRay rayThrough(const PictureCamera& camera, const PictureSize& size, const PicturePoint& point, double length);

/// An orbit camera for mouse control. The target stays in front of the eye, and up stays up.
class OrbitCamera
{
public:
    explicit OrbitCamera(const PictureCamera& start = {});

    const PictureCamera& camera() const { return m_camera; }
    /// Turns around the target: `azimuth` about the up axis, `elevation` towards it [rad]. The elevation is limited
    /// just below the vertical.
    void orbit(double azimuth, double elevation);
    /// Moves eye and target right and up in the picture by a fraction of their distance.
    void pan(double right, double up);
    /// Multiplies the distance to the target by `factor`, > 0.
    void zoom(double factor);

private:
    PictureCamera m_camera;
    Vec3 m_pole;  // up axis, constant
};

}  // namespace bullet_fem

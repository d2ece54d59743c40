// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include "bullet_fem/fem/common/vec3.h"

namespace bullet_fem
{

/// The vector of length 1 along `a`, which is not 0.
Vec3 unit(const Vec3& a);

/// Pixels of a picture.
struct PictureSize
{
    int m_width = 1280, m_height = 720;  ///< [pixels], > 0
};

/// A perspective camera.
struct PictureCamera
{
    Vec3 m_eye{2, 1.2, 3}, m_target, m_up{0, 1, 0};  ///< [m]; eye and target differ, up is not along the view
    double m_fieldOfView = 0.6;                      ///< from the lower to the upper border [rad], in (0, 3)
};

/// The camera's axes, each of length 1 and at right angles to each other.
struct CameraAxes
{
    Vec3 m_right, m_up, m_back;
};
CameraAxes axes(const PictureCamera& camera);

/// A place in a picture [pixels], from the upper left corner; pixel (i, j) has its centre at (i + 0.5, j + 0.5).
struct PicturePoint
{
    double m_x = 0, m_y = 0;
};

/// Where `point` is seen. It must lie before the camera.
PicturePoint projected(const PictureCamera& camera, const PictureSize& size, const Vec3& point);

/// A straight line from the camera into the scene [m].
struct PictureRay
{
    Vec3 m_from, m_to;
};

/// The ray that is seen as `point`, from the eye on, `length` [m] long.
PictureRay rayThrough(const PictureCamera& camera, const PictureSize& size, const PicturePoint& point, double length);

/// A camera that a mouse leads around a target. The target stays before the eye, and up stays up.
class OrbitCamera
{
public:
    explicit OrbitCamera(const PictureCamera& start = {});

    const PictureCamera& camera() const { return m_camera; }
    /// Turns around the target: `azimuth` about the axis that points up, `elevation` towards it [rad]. It stops short
    /// of looking straight down or up.
    void orbit(double azimuth, double elevation);
    /// Moves eye and target by a share of the distance between them, to the right and upwards in the picture.
    void pan(double right, double up);
    /// Multiplies the distance to the target by `factor`, > 0.
    void zoom(double factor);

private:
    PictureCamera m_camera;
    Vec3 m_pole;  // up, which orbits keep
};

}  // namespace bullet_fem

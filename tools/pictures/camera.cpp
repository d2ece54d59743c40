// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "tools/pictures/camera.h"

#include <algorithm>

namespace bullet_fem
{
namespace
{

constexpr double kSteepest = 1.54;  // elevation [rad]: at pi/2 left and right are undefined

/// Half the height of the view at distance 1; then its ratio of width to height.
double slope(const PictureCamera& camera)
{
    return std::tan(0.5 * camera.m_fieldOfView);
}
double aspect(const PictureSize& size)
{
    return static_cast<double>(size.m_width) / size.m_height;
}

}  // namespace

Vec3 unit(const Vec3& a)
{
    return a * (1 / norm(a));
}

CameraAxes axes(const PictureCamera& camera)
{
    CameraAxes a;
    a.m_back = unit(camera.m_eye - camera.m_target);
    a.m_right = unit(cross(camera.m_up, a.m_back));
    a.m_up = cross(a.m_back, a.m_right);
    return a;
}

PicturePoint projected(const PictureCamera& camera, const PictureSize& size, const Vec3& point)
{
    const CameraAxes a = axes(camera);
    const Vec3 r = point - camera.m_eye;
    const double depth = -dot(r, a.m_back), s = slope(camera);
    const double x = dot(r, a.m_right) / (depth * s * aspect(size)), y = dot(r, a.m_up) / (depth * s);
    return {0.5 * size.m_width * (1 + x), 0.5 * size.m_height * (1 - y)};
}

PictureRay rayThrough(const PictureCamera& camera, const PictureSize& size, const PicturePoint& point, double length)
{
    const CameraAxes a = axes(camera);
    const double s = slope(camera);
    const double x = (2 * point.m_x / size.m_width - 1) * s * aspect(size), y = (1 - 2 * point.m_y / size.m_height) * s;
    return {camera.m_eye, camera.m_eye + length * unit(x * a.m_right + y * a.m_up - a.m_back)};
}

OrbitCamera::OrbitCamera(const PictureCamera& start) : m_camera(start), m_pole(unit(start.m_up)) {}

void OrbitCamera::orbit(double azimuth, double elevation)
{
    const CameraAxes a = axes(m_camera);
    const double distance = norm(m_camera.m_eye - m_camera.m_target);
    const double now = std::asin(std::clamp(dot(a.m_back, m_pole), -1.0, 1.0));
    const double next = std::clamp(now + elevation, -kSteepest, kSteepest);
    const Vec3 ahead = cross(a.m_right, m_pole);  // horizontal, from the target towards the eye
    const Vec3 level = std::cos(azimuth) * ahead + std::sin(azimuth) * a.m_right;
    m_camera.m_eye = m_camera.m_target + distance * (std::cos(next) * level + std::sin(next) * m_pole);
    m_camera.m_up = m_pole;
}

void OrbitCamera::pan(double right, double up)
{
    const CameraAxes a = axes(m_camera);
    const Vec3 way = norm(m_camera.m_eye - m_camera.m_target) * (right * a.m_right + up * a.m_up);
    m_camera.m_eye += way;
    m_camera.m_target += way;
}

void OrbitCamera::zoom(double factor)
{
    m_camera.m_eye = m_camera.m_target + factor * (m_camera.m_eye - m_camera.m_target);
}

}  // namespace bullet_fem

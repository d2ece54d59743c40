// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "tools/pictures/picture_scene.h"

#include <algorithm>
#include <cmath>

#include "fem/common/message.h"

namespace bullet_fem
{
namespace
{

constexpr double kHalfTurn = 3.14159265358979323846;
constexpr double kFramingMargin = 1.12;  // empty border, relative to the picture
constexpr double kLargest = 1e15;        // [m] and units: squares of it stay within single precision

// Each check returns an empty text, or the error.

bool usable(const Vec3& v)
{
    return isFinite(v) && std::abs(v.x) < kLargest && std::abs(v.y) < kLargest && std::abs(v.z) < kLargest;
}

std::string text(const Vec3& v)
{
    return message("(", v.x, ", ", v.y, ", ", v.z, ")");
}

std::string vectorFault(const char* what, const Vec3& v)
{
    if (usable(v)) return {};
    return message(what, " is ", text(v), "; it must be finite and below 1e15");
}

std::string directionFault(const char* what, const Vec3& v)
{
    const std::string fault = vectorFault(what, v);
    if (!fault.empty()) return fault;
    return norm(v) > 0 ? std::string() : message(what, " is ", text(v), "; it must have a length");
}

std::string rangeFault(const char* what, double value, double low, double high)
{
    if (value >= low && value <= high) return {};
    return message(what, " is ", value, "; it must be in [", low, ", ", high, "]");
}

std::string colourFault(const char* what, const Colour& c)
{
    for (const double part : {c.r, c.g, c.b})
        if (!(part >= 0 && part <= 1)) return message(what, " has a part of ", part, "; it must be in [0, 1]");
    return {};
}

std::string fault(const PictureMesh& mesh)
{
    const auto count = mesh.m_positions.size();
    for (std::size_t i = 0; i < count; ++i)
        if (!usable(mesh.m_positions[i])) return vectorFault(message("position ", i).c_str(), mesh.m_positions[i]);
    for (std::size_t t = 0; t < mesh.m_triangles.size(); ++t)
        for (const int node : mesh.m_triangles[t])
            if (node < 0 || static_cast<std::size_t>(node) >= count)
                return message("triangle ", t, " has index ", node, "; it must be in [0, ", count,
                               "), the number of positions");
    if (!mesh.m_scalars.empty() && mesh.m_scalars.size() != count)
        return message("there are ", mesh.m_scalars.size(), " scalars for ", count,
                       " positions; give one each, or none");
    for (std::size_t i = 0; i < mesh.m_scalars.size(); ++i)
        if (!std::isfinite(mesh.m_scalars[i]))
            return message("scalar ", i, " is ", mesh.m_scalars[i], "; it must be finite");
    const std::string crease = rangeFault("the crease angle", mesh.m_creaseAngle, 0, kHalfTurn);
    return crease.empty() ? colourFault("the colour", mesh.m_colour) : crease;
}

std::string fault(const PictureArrows& arrows)
{
    for (std::size_t i = 0; i < arrows.m_arrows.size(); ++i)
    {
        const PictureArrow& arrow = arrows.m_arrows[i];
        for (const auto& [what, v] :
             {std::make_pair("origin ", arrow.m_origin), std::make_pair("vector ", arrow.m_vector)})
            if (!usable(v)) return vectorFault(message(what, i).c_str(), v);
        if (!usable(arrows.m_scale * arrow.m_vector)) return message("vector ", i, " times the scale exceeds 1e15 m");
    }
    if (!(arrows.m_scale > 0 && arrows.m_scale < kLargest))
        return message("the scale is ", arrows.m_scale, " m a unit; it must be > 0 and finite");
    if (!(arrows.m_thickness >= 0 && arrows.m_thickness < kLargest))
        return message("the thickness is ", arrows.m_thickness,
                       " m; it must be >= 0, where 0 means chosen by the scene's size");
    return colourFault("the colour", arrows.m_colour);
}

std::string fault(const PictureGround& ground)
{
    std::string f = vectorFault("the ground's point", ground.m_point);
    if (f.empty()) f = directionFault("the ground's normal", ground.m_normal);
    if (f.empty()) f = rangeFault("the ground's grid spacing [m]", ground.m_gridSpacing, 0, kLargest);
    return f.empty() ? colourFault("the ground's colour", ground.m_colour) : f;
}

std::string fault(const PictureCamera& camera)
{
    std::string f = vectorFault("the camera's eye", camera.m_eye);
    if (f.empty()) f = vectorFault("the camera's target", camera.m_target);
    if (f.empty()) f = directionFault("the camera's up", camera.m_up);
    if (!f.empty()) return f;
    const Vec3 view = camera.m_target - camera.m_eye;
    if (!(norm(view) > 0))
        return message("the camera's eye and target are both ", text(camera.m_eye), "; they must differ");
    if (norm(cross(view, camera.m_up)) < 1e-9 * norm(view) * norm(camera.m_up))
        return "the camera's up, " + text(camera.m_up) + ", is along its view; it must point elsewhere";
    if (!(camera.m_fieldOfView > 0 && camera.m_fieldOfView < 3))
        return message("the camera's field of view is ", camera.m_fieldOfView, " rad; it must be in (0, 3)");
    return {};
}

std::string fault(const PictureBounds& box)
{
    if (usable(box.m_low) && usable(box.m_high) && box.radius() > 0) return {};
    return message("the bounds are ", text(box.m_low), " to ", text(box.m_high),
                   "; they must be finite, below 1e15 m, and enclose something");
}

std::string fault(const PictureColourScale& scale)
{
    if (std::isfinite(scale.m_low) && std::isfinite(scale.m_high) && scale.m_low < scale.m_high) return {};
    return message("the colour scale's range is ", scale.m_low, " to ", scale.m_high,
                   "; it must be finite, and its low end below its high end");
}

/// Error of the i-th item of a kind, with a prefix.
template <typename Things>
std::string faultOfAny(const char* kind, const Things& things)
{
    for (std::size_t i = 0; i < things.size(); ++i)
    {
        const std::string f = fault(things[i]);
        if (!f.empty()) return message(kind, " ", i, ": ", f);
    }
    return {};
}

}  // namespace

bool valid(const PictureScene& scene, const PictureCamera& camera, std::string* why)
{
    const auto light = [&]
    {
        const std::string f = directionFault("the direction towards the light", scene.m_light.m_towards);
        return f.empty() ? rangeFault("the light's size", scene.m_light.m_size, 0, 0.5) : f;
    };
    const auto background = [&]
    {
        const std::string f = colourFault("the sky's colour", scene.m_sky);
        return f.empty() ? colourFault("the horizon's colour", scene.m_horizon) : f;
    };
    std::string f = fault(camera);
    if (f.empty()) f = faultOfAny("mesh", scene.m_meshes);
    if (f.empty()) f = faultOfAny("arrows", scene.m_arrows);
    if (f.empty()) f = fault(scene.m_ground);
    if (f.empty()) f = light();
    if (f.empty()) f = background();
    if (f.empty()) f = fault(scene.m_colourScale);
    if (f.empty()) f = rangeFault("the text's size", scene.m_textSize, 0.1, 10);
    if (f.empty() && scene.m_bounds) f = fault(*scene.m_bounds);
    if (why) *why = f.empty() ? std::string() : "picture: " + f;
    return f.empty();
}

PictureBounds bounds(const PictureScene& scene)
{
    bool any = false;
    PictureBounds box;
    const auto add = [&](const Vec3& x)
    {
        if (!any) box = {x, x};
        any = true;
        for (int k = 0; k < 3; ++k)
        {
            box.m_low[k] = std::min(box.m_low[k], x[k]);
            box.m_high[k] = std::max(box.m_high[k], x[k]);
        }
    };
    for (const PictureMesh& mesh : scene.m_meshes)
        for (const Vec3& x : mesh.m_positions) add(x);
    for (const PictureArrows& arrows : scene.m_arrows)
        for (const PictureArrow& arrow : arrows.m_arrows) add(arrow.m_origin);
    if (!any) box = {{-0.5, -0.5, -0.5}, {0.5, 0.5, 0.5}};
    return box;
}

PictureCamera framing(const PictureScene& scene, const Vec3& direction, const Vec3& up, const PictureSize& size)
{
    PictureCamera camera;
    const PictureBounds box = bounds(scene);
    const double high = std::tan(0.5 * camera.m_fieldOfView) / kFramingMargin,
                 wide = high * size.m_width / size.m_height;
    camera.m_target = box.centre();
    camera.m_eye = camera.m_target + direction;
    camera.m_up = up;
    const CameraAxes a = axes(camera);
    double distance = box.radius() > 0 ? 0.1 * box.radius() : 1;
    for (const PictureMesh& mesh : scene.m_meshes)
        for (const Vec3& x : mesh.m_positions)
        {
            const Vec3 r = x - camera.m_target;
            const double aside = std::max(std::abs(dot(r, a.m_right)) / wide, std::abs(dot(r, a.m_up)) / high);
            distance = std::max(distance, dot(r, a.m_back) + aside);
        }
    camera.m_eye = camera.m_target + distance * a.m_back;
    return camera;
}

}  // namespace bullet_fem

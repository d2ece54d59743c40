// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "bullet_bridge/contact/rigid/sheet_contact.h"

#include <algorithm>

namespace bullet_fem
{

namespace
{

constexpr double kShort =
    0.01;  // part of a way to a point of a face that is not looked along: the point may be on a rim
constexpr int kMaxCrossings = 4;  // largest number of sheets that a point is moved back through

void addPointContact(std::vector<SheetContact>& touches, const SheetContact& touch)
{
    for (SheetContact& known : touches)
        if (dot(known.m_surface.m_normal, touch.m_surface.m_normal) > kParallelNormals)
        {
            if (touch.m_surface.m_gap < known.m_surface.m_gap) known = touch;
            return;
        }
    touches.push_back(touch);
}

SheetContact planeContact(const TriangleSoup& soup, const SheetProbe& probe, int triangle, const Vec3& normal)
{
    const Vec3& onPlane = soup.triangles()[triangle].m_corners[0];
    const double gap = dot(normal, probe.m_position - onPlane) - probe.m_thickness;
    return {{gap, normal, {1, 0, 0}}, triangle};
}

// The contact with a triangle's plane, with the normal to the side on which the point is.
SheetContact contactOnItsSide(const TriangleSoup& soup, const SheetProbe& probe, int t)
{
    const SoupTriangle& triangle = soup.triangles()[t];
    const double height = dot(triangle.m_normal, probe.m_rightSide - triangle.m_corners[0]);
    return planeContact(soup, probe, t, height < 0 ? -triangle.m_normal : triangle.m_normal);
}

// Removes triangles that are hidden behind another one: their planes do not constrain the point.
void removeHiddenFaces(const TriangleSoup& soup, const SheetProbe& probe, std::vector<SheetContact>& touches)
{
    if (touches.size() < 2) return;
    const auto isHidden = [&](const SheetContact& touch)
    {
        const Vec3& n = touch.m_surface.m_normal;
        const double height = dot(n, probe.m_rightSide - soup.triangles()[touch.m_triangle].m_corners[0]);
        const double before = height - 10 * soup.tolerance();
        return before > 0 && soup.firstCrossing(probe.m_rightSide, probe.m_rightSide - before * n).m_triangle >= 0;
    };
    touches.erase(std::remove_if(touches.begin(), touches.end(), isHidden), touches.end());
}

void addFaces(const TriangleSoup& soup, const SheetProbe& probe, std::vector<SheetContact>& touches)
{
    // The foot of the point on a plane that its path reaches lies within the ball whose diameter is the path.
    const Vec3& p = probe.m_rightSide;
    const Vec3 middle = p + 0.5 * probe.m_path;
    const double reach = 0.5 * norm(probe.m_path) + probe.m_band + probe.m_thickness + norm(p - probe.m_position);
    const Vec3 box = {reach, reach, reach};
    soup.forEachIn(middle - box, middle + box,
                   [&](int t)
                   {
                       const SheetContact touch = contactOnItsSide(soup, probe, t);
                       const Vec3& normal = touch.m_surface.m_normal;
                       if (touch.m_surface.m_gap + std::min(0.0, dot(normal, probe.m_path)) > probe.m_band) return;
                       if (nearestOn(soup.triangles()[t], p).m_onFace) addPointContact(touches, touch);
                   });
}

void addEdgesAndCorners(const TriangleSoup& soup, const SheetProbe& probe, std::vector<SheetContact>& touches)
{
    const Vec3& p = probe.m_rightSide;
    const double reach = probe.m_band + probe.m_thickness + norm(p - probe.m_position);
    const Vec3 box = {reach, reach, reach};
    soup.forEachIn(p - box, p + box,
                   [&](int t)
                   {
                       const SoupPoint nearest = nearestOn(soup.triangles()[t], p);
                       const Vec3 way = p - nearest.m_point;
                       const double distance = norm(way);
                       if (nearest.m_onFace || distance > reach || !(distance > 0)) return;
                       if (!soup.isNearestAround(nearest.m_point, p, distance)) return;
                       const Vec3 normal = way * (1 / distance);
                       const double gap = dot(normal, probe.m_position - nearest.m_point) - probe.m_thickness;
                       if (gap <= probe.m_band) addPointContact(touches, {{gap, normal, {1, 0, 0}}, t});
                   });
}

// Extends the path by the thickness and the band. A face whose offset surface the point is within already does not
// count: it is below the point, and known, or beside it.
void addFirstOnPath(const TriangleSoup& soup, const SheetProbe& probe, std::vector<SheetContact>& touches)
{
    const double length = norm(probe.m_path);
    if (!(length > 0)) return;
    const Vec3 path = probe.m_path * (1 + (probe.m_thickness + probe.m_band) / length);
    const SoupCrossing crossing = soup.firstCrossing(probe.m_rightSide, probe.m_rightSide + path);
    if (crossing.m_triangle < 0) return;
    const SheetContact touch = planeContact(soup, probe, crossing.m_triangle, crossing.m_normal);
    if (touch.m_surface.m_gap >= 0) addPointContact(touches, touch);
}

}  // namespace

Vec3 onRightSide(const TriangleSoup& soup, const Vec3& safe, const Vec3& position)
{
    // The clearance keeps rounding from crossing the sheet again.
    const double clearance = soup.tolerance();
    Vec3 p = position;
    for (int k = 0; k < kMaxCrossings; ++k)
    {
        const SoupCrossing crossing = soup.firstCrossing(safe, p, clearance);
        if (crossing.m_triangle < 0) return p;
        const Vec3& n = crossing.m_normal;
        p += (2 * clearance - dot(n, p - soup.triangles()[crossing.m_triangle].m_corners[0])) * n;
    }
    return safe;
}

void findPointContacts(const TriangleSoup& soup, const SheetProbe& probe, std::vector<SheetContact>& touches)
{
    touches.clear();
    addFaces(soup, probe, touches);
    removeHiddenFaces(soup, probe, touches);
    addEdgesAndCorners(soup, probe, touches);
    addFirstOnPath(soup, probe, touches);
}

void findContactsAtEnd(const TriangleSoup& soup, const SheetProbe& probe, double beyond,
                       std::vector<SheetContact>& touches)
{
    touches.clear();
    const Vec3& p = probe.m_rightSide;
    const Vec3 end = p + probe.m_path;
    const double reach = norm(probe.m_path) + probe.m_band + probe.m_thickness;
    const Vec3 box = {reach, reach, reach};
    soup.forEachIn(end - box, end + box,
                   [&](int t)
                   {
                       const SheetContact touch = contactOnItsSide(soup, probe, t);
                       const Vec3& normal = touch.m_surface.m_normal;
                       if (touch.m_surface.m_gap + dot(normal, probe.m_path) > probe.m_band) return;
                       const SoupPoint foot = nearestOn(soup.triangles()[t], end);
                       const Vec3 off = end - foot.m_point;
                       if (!foot.m_onFace && norm(off - dot(off, normal) * normal) > beyond) return;
                       const Vec3 above = foot.m_point + 10 * soup.tolerance() * normal;
                       if (soup.firstCrossing(p, above + kShort * (p - above)).m_triangle < 0)
                           addPointContact(touches, touch);
                   });
}

}  // namespace bullet_fem

// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "tools/pictures/mesh_vertices.h"

#include <algorithm>
#include <cmath>

namespace bullet_fem
{
namespace
{

constexpr double kPi = 3.14159265358979323846;
constexpr int kSides = 16;                            // of an arrow
constexpr double kDefaultThickness = 1. / 75;         // of arrows, over the scene's radius
constexpr double kHeadLength = 4, kHeadRadius = 1.4;  // in units of the thickness; short arrows have smaller heads
constexpr double kHeadShare = 0.5;                    // maximum, of an arrow's length
constexpr double kShortest = 1e-3;                    // over the longest arrow

constexpr double kFarOut = 1e6;  // limit in units of the colour map, within single precision

Vec3 upright(const Vec3& a)
{
    const double length = norm(a);
    return length > 0 ? a * (1 / length) : Vec3{0, 1, 0};
}

PictureVertex vertex(const Vec3& position, const Vec3& normal, double share)
{
    const auto f = [](double d) { return static_cast<float>(d); };
    return {{f(position.x), f(position.y), f(position.z)}, {f(normal.x), f(normal.y), f(normal.z)}, f(share)};
}

/// Faces around each position: those of i are m_faces[m_first[i]] to m_faces[m_first[i + 1]].
struct FacesAround
{
    std::vector<int> m_first, m_faces;

    explicit FacesAround(const PictureMesh& mesh)
        : m_first(mesh.m_positions.size() + 1), m_faces(3 * mesh.m_triangles.size())
    {
        for (const Triangle& t : mesh.m_triangles)
            for (const int i : t) ++m_first[i + 1];
        for (std::size_t i = 1; i < m_first.size(); ++i) m_first[i] += m_first[i - 1];
        std::vector<int> next(m_first.begin(), m_first.end() - 1);
        for (std::size_t t = 0; t < mesh.m_triangles.size(); ++t)
            for (const int i : mesh.m_triangles[t]) m_faces[next[i]++] = static_cast<int>(t);
    }
};

/// An arrow as a body of revolution: its axes, and radii along the axis with the slope of the normal.
struct Lathe
{
    Vec3 m_start, m_axis, m_u, m_v;

    Vec3 radial(int side) const
    {
        const double angle = 2 * kPi * side / kSides;
        return std::cos(angle) * m_u + std::sin(angle) * m_v;
    }
    /// Appends a ring of triangles between two radii at two places [m] along the axis.
    void append(double at0, double r0, double at1, double r1, std::vector<PictureVertex>& out) const
    {
        for (int side = 0; side < kSides; ++side)
        {
            const Vec3 a = radial(side), b = radial(side + 1);
            const auto corner = [&](const Vec3& outward, double at, double r)
            {
                const Vec3 normal = upright((at1 - at0) * outward - (r1 - r0) * m_axis);
                return vertex(m_start + at * m_axis + r * outward, normal, 0);
            };
            const PictureVertex p = corner(a, at0, r0), q = corner(b, at0, r0), s = corner(b, at1, r1),
                                t = corner(a, at1, r1);
            for (const PictureVertex& v : {p, q, s, p, s, t}) out.push_back(v);
        }
    }
};

void appendArrow(const Vec3& start, const Vec3& vector, double thickness, std::vector<PictureVertex>& out)
{
    const double length = norm(vector), head = std::min(kHeadLength * thickness, kHeadShare * length);
    const double width = head * kHeadRadius / kHeadLength, shaft = std::min(0.5 * thickness, 0.5 * width);
    Lathe lathe{start, upright(vector), {}, {}};
    lathe.m_u = upright(cross(lathe.m_axis, std::abs(lathe.m_axis.x) < 0.7 ? Vec3{1, 0, 0} : Vec3{0, 1, 0}));
    lathe.m_v = cross(lathe.m_axis, lathe.m_u);
    lathe.append(0, 0, 0, shaft, out);
    lathe.append(0, shaft, length - head, shaft, out);
    lathe.append(length - head, shaft, length - head, width, out);
    lathe.append(length - head, width, length, 0, out);
}

}  // namespace

void appendVertices(const PictureMesh& mesh, const PictureUnits& units, const PictureColourScale& scale,
                    std::vector<PictureVertex>& vertices)
{
    const FacesAround around(mesh);
    std::vector<Vec3> area(mesh.m_triangles.size()), direction(mesh.m_triangles.size());
    for (std::size_t t = 0; t < area.size(); ++t)
    {
        const Triangle& c = mesh.m_triangles[t];
        const Vec3& a = mesh.m_positions[c[0]];
        area[t] = cross(mesh.m_positions[c[1]] - a, mesh.m_positions[c[2]] - a);
        direction[t] = upright(area[t]);
    }
    const auto share = [&](int i)
    {
        if (mesh.m_scalars.empty()) return 0.;
        return std::clamp((mesh.m_scalars[i] - scale.m_low) / (scale.m_high - scale.m_low), -kFarOut, kFarOut);
    };
    const double flattest = std::cos(mesh.m_creaseAngle) - 1e-12;
    for (std::size_t t = 0; t < area.size(); ++t)
        for (const int i : mesh.m_triangles[t])
        {
            Vec3 normal;
            for (int k = around.m_first[i]; k < around.m_first[i + 1]; ++k)
                if (dot(direction[around.m_faces[k]], direction[t]) >= flattest) normal += area[around.m_faces[k]];
            const Vec3& own = direction[t];
            vertices.push_back(
                vertex(units.place(mesh.m_positions[i]), norm(normal) > 0 ? upright(normal) : own, share(i)));
        }
}

void appendVertices(const PictureArrows& arrows, const PictureUnits& units, std::vector<PictureVertex>& vertices)
{
    double longest = 0;
    for (const PictureArrow& arrow : arrows.m_arrows) longest = std::max(longest, norm(arrow.m_vector));
    const double thickness = arrows.m_thickness > 0 ? arrows.m_thickness / units.m_length : kDefaultThickness;
    for (const PictureArrow& arrow : arrows.m_arrows)
        if (norm(arrow.m_vector) > kShortest * longest)
            appendArrow(units.place(arrow.m_origin), (arrows.m_scale / units.m_length) * arrow.m_vector, thickness,
                        vertices);
}

}  // namespace bullet_fem

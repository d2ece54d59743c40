// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "tools/scene/scene_faults.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <map>
#include <memory>
#include <utility>

#include "BulletSoftBody/btSoftBody.h"
#include "bullet_fem/btFemCollision.h"
#include "bullet_fem/btFemVectors.h"
#include "bullet_fem/fem/cage/surface_mesh.h"
#include "bullet_fem/fem/cage/winding_number.h"
#include "fem/common/disjoint_sets.h"
#include "fem/common/message.h"

namespace bullet_fem
{
namespace
{

constexpr double kInsideOutShare = 1e-4;  // relative to an element's initial volume; rounding inverts slivers

double squaredNorm(const Vec3& a)
{
    return dot(a, a);
}

/// Squared distance of a point from a triangle [m2] [Ericson 2005, 5.1.5].
double squaredDistance(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c)
{
    const Vec3 ab = b - a, ac = c - a, ap = p - a;
    const double d1 = dot(ab, ap), d2 = dot(ac, ap);
    if (d1 <= 0 && d2 <= 0) return squaredNorm(ap);
    const Vec3 bp = p - b;
    const double d3 = dot(ab, bp), d4 = dot(ac, bp);
    if (d3 >= 0 && d4 <= d3) return squaredNorm(bp);
    const double vc = d1 * d4 - d3 * d2;
    if (vc <= 0 && d1 >= 0 && d3 <= 0) return squaredNorm(ap - d1 / (d1 - d3) * ab);
    const Vec3 cp = p - c;
    const double d5 = dot(ab, cp), d6 = dot(ac, cp);
    if (d6 >= 0 && d5 <= d6) return squaredNorm(cp);
    const double vb = d5 * d2 - d1 * d6;
    if (vb <= 0 && d2 >= 0 && d6 <= 0) return squaredNorm(ap - d2 / (d2 - d6) * ac);
    const double va = d3 * d6 - d5 * d4;
    if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0) return squaredNorm(bp - (d4 - d3) / ((d4 - d3) + (d5 - d6)) * (c - b));
    return squaredNorm(ap - vb / (va + vb + vc) * ab - vc / (va + vb + vc) * ac);
}

double volumeOf(const Tet& t, const std::vector<Vec3>& x)
{
    return dot(cross(x[t[1]] - x[t[0]], x[t[2]] - x[t[0]]), x[t[3]] - x[t[0]]) / 6;
}

const SceneBox kNothing{{1e300, 1e300, 1e300}, {-1e300, -1e300, -1e300}};

void extend(SceneBox& box, const Vec3& x)
{
    for (int i = 0; i < 3; ++i)
    {
        box.m_low[i] = std::min(box.m_low[i], x[i]);
        box.m_high[i] = std::max(box.m_high[i], x[i]);
    }
}

bool overlap(const SceneBox& a, const SceneBox& b)
{
    for (int i = 0; i < 3; ++i)
        if (a.m_low[i] > b.m_high[i] || b.m_low[i] > a.m_high[i]) return false;
    return true;
}

/// A body that gives the penetration depth of points.
class Solid
{
public:
    /// `points` are its points that must not be inside other bodies.
    Solid(std::string name, const BodyFrame& surface, std::vector<Vec3> points, double size)
        : m_name(std::move(name)), m_surface(&surface), m_points(std::move(points)), m_size(size)
    {
        for (const Vec3& x : surface.m_positions) extend(m_box, x);
        m_reach = m_box;
        for (const Vec3& x : m_points) extend(m_reach, x);
    }
    /// The half space below a plane.
    Solid(std::string name, const Vec3& origin, const Vec3& normal)
        : m_name(std::move(name)), m_origin(origin), m_normal((1 / norm(normal)) * normal)
    {
    }

    const std::string& name() const { return m_name; }
    double size() const { return m_size; }
    bool isNear(const Solid& other) const { return !m_surface || !other.m_surface || overlap(m_reach, other.m_reach); }

    /// Penetration depth of a point [m]; 0 outside.
    double depth(const Vec3& p) const
    {
        if (!m_surface) return std::max(0.0, dot(m_normal, m_origin - p));
        if (!m_box.contains(p)) return 0;
        const std::vector<Vec3>& x = m_surface->m_positions;
        if (!m_winding) m_winding = std::make_unique<WindingNumber>(x, m_surface->m_triangles);
        if (m_winding->at(p) < 0.5) return 0;
        double least = std::numeric_limits<double>::infinity();
        for (const Triangle& t : m_surface->m_triangles)
            least = std::min(least, squaredDistance(p, x[t[0]], x[t[1]], x[t[2]]));
        return std::sqrt(least);
    }

    /// Penetration depth of the other body's deepest point [m].
    double depth(const Solid& other) const
    {
        double most = 0;
        for (const Vec3& p : other.m_points) most = std::max(most, depth(p));
        return most;
    }

private:
    std::string m_name;
    const BodyFrame* m_surface = nullptr;  // null: a plane
    Vec3 m_origin, m_normal;
    std::vector<Vec3> m_points;
    SceneBox m_box = kNothing, m_reach;                       // bounds of the surface; bounds including `points`
    double m_size = std::numeric_limits<double>::infinity();  // cube root of its volume [m]
    mutable std::unique_ptr<WindingNumber> m_winding;         // created on first use
};

/// Checks all bodies of a world.
class FaultSearch
{
public:
    FaultSearch(const SceneWorld& world, const SceneFrames& frames)
        : m_world(world), m_frames(frames), m_welded(world.softCount())
    {
        for (int i = 0; i < world.softCount(); ++i) addSoft(i);
        for (int i = 0; i < world.rigidCount(); ++i) addRigid(i);
        joinWelded();
    }

    std::vector<SceneFault> find()
    {
        for (int a = 0; a < m_world.softCount(); ++a)
        {
            if (m_insideOut[a] > 0)
            {
                SceneFault fault;
                fault.m_body = m_solids[a].name();
                fault.m_elements = m_insideOut[a];
                m_faults.push_back(fault);
            }
            for (std::size_t b = 0; b < m_solids.size(); ++b)
            {
                const bool isSoft = static_cast<int>(b) < m_world.softCount();
                if ((isSoft && static_cast<int>(b) <= a) || !m_solids[a].isNear(m_solids[b])) continue;
                if (!isTied(a, b)) compare(m_solids[a], m_solids[b]);
            }
        }
        return std::move(m_faults);
    }

private:
    // The initial volume defines the size, because crushed bodies have less.
    void addSoft(int i)
    {
        const BodyFrame& volume = m_frames.volumes()[i];
        std::vector<Vec3> start = volume.m_positions;
        for (std::size_t n = 0; n < start.size(); ++n) start[n] -= volume.m_displacement[n];
        double whole = 0;
        int insideOut = 0;
        for (const Tet& t : volume.m_tets)
        {
            const double rest = volumeOf(t, start);
            whole += rest;
            insideOut += volumeOf(t, volume.m_positions) < -kInsideOutShare * std::fabs(rest);
        }
        m_insideOut.push_back(insideOut);
        m_solids.emplace_back(m_world.description().m_softBodies[i].m_name, m_frames.surfaces()[i], pointsOf(i),
                              std::cbrt(whole));
        m_objects.push_back(&m_world.soft(i));
    }

    // All nodes of elements, or those of the surface if it collides instead of the cage.
    std::vector<Vec3> pointsOf(int i) const
    {
        if (m_world.soft(i).m_cfg.collisions & BT_FEM_RENDER_SURFACE) return m_frames.surfaces()[i].m_positions;
        const BodyFrame& volume = m_frames.volumes()[i];
        std::vector<Vec3> points;
        std::vector<bool> isTaken(volume.m_positions.size());
        for (const Tet& t : volume.m_tets)
            for (const int node : t)
            {
                if (!isTaken[node]) points.push_back(volume.m_positions[node]);
                isTaken[node] = true;
            }
        return points;
    }

    void addRigid(int i)
    {
        const SceneRigidBody& body = m_world.description().m_rigidBodies[i];
        const btTransform& pose = m_world.rigid(i).getWorldTransform();
        m_objects.push_back(&m_world.rigid(i));
        if (body.m_shape.m_kind == SceneShape::Kind::plane)
        {
            m_solids.emplace_back(body.m_name, vec3(pose.getOrigin()),
                                  vec3(pose.getBasis() * bulletVector(body.m_shape.m_size)));
            return;
        }
        while (m_frames.bodyOf(m_nextSurface) != m_world.softCount() + i) ++m_nextSurface;
        const BodyFrame& surface = m_frames.surfaces()[m_nextSurface];
        m_solids.emplace_back(body.m_name, surface, surface.m_positions,
                              std::cbrt(signedVolume({surface.m_positions, surface.m_triangles, {}})));
    }

    // Bodies connected by welds count as one body, whose self-contact is not checked.
    void joinWelded()
    {
        std::map<const btCollisionObject*, int> softBodies;
        for (int i = 0; i < m_world.softCount(); ++i) softBodies[m_objects[i]] = i;
        for (const auto& [object, i] : softBodies)
        {
            const auto& anchors = m_world.fem().anchors(&m_world.soft(i));
            for (int k = 0; k < anchors.size(); ++k)
                if (const auto other = softBodies.find(anchors[k].m_object); other != softBodies.end())
                    m_welded.join(i, other->second);
        }
    }

    // Whether both are connected by anchors or welds, or one has nodes pinned inside the other.
    bool isTied(int a, std::size_t b)
    {
        const btSoftBody& soft = m_world.soft(a);
        if (static_cast<int>(b) < m_world.softCount() && m_welded.root(a) == m_welded.root(static_cast<int>(b)))
            return true;
        for (int k = 0; k < soft.m_collisionDisabledObjects.size(); ++k)
            if (soft.m_collisionDisabledObjects[k] == m_objects[b]) return true;
        const auto isPinnedIn = [](const btSoftBody& body, const Solid& solid)
        {
            for (int n = 0; n < body.m_nodes.size(); ++n)
                if (body.m_nodes[n].m_im == 0 && solid.depth(vec3(body.m_nodes[n].m_x)) > 0) return true;
            return false;
        };
        return isPinnedIn(soft, m_solids[b]) || (static_cast<int>(b) < m_world.softCount() &&
                                                 isPinnedIn(m_world.soft(static_cast<int>(b)), m_solids[a]));
    }

    void compare(const Solid& a, const Solid& b)
    {
        const double inside = b.depth(a), around = a.depth(b), size = std::min(a.size(), b.size());
        if (std::max(inside, around) <= kDeepestShare * size) return;
        SceneFault fault;
        fault.m_body = inside >= around ? a.name() : b.name();
        fault.m_other = inside >= around ? b.name() : a.name();
        fault.m_depth = std::max(inside, around);
        fault.m_share = fault.m_depth / size;
        m_faults.push_back(fault);
    }

    const SceneWorld& m_world;
    const SceneFrames& m_frames;
    std::vector<Solid> m_solids;                      // soft bodies, then rigid bodies
    std::vector<const btCollisionObject*> m_objects;  // of each solid
    std::vector<int> m_insideOut;                     // inverted elements of each soft body
    DisjointSets m_welded;                            // soft bodies connected by welds
    std::vector<SceneFault> m_faults;
    int m_nextSurface = 0;
};

}  // namespace

std::string SceneFault::sentence() const
{
    if (m_other.empty())
        return message("'", m_body, "' has ", m_elements, m_elements == 1 ? " element" : " elements",
                       " inside out: it is crushed or twisted; take a stiffer material, the Neo-Hookean law, a coarser "
                       "mesh, lighter loads or smaller steps");
    char depth[64];
    std::snprintf(depth, sizeof depth, "%.3g m deep (%.0f %% of the smaller one's size)", m_depth, 100 * m_share);
    return message("'", m_body, "' is in '", m_other, "', ", depth,
                   ": start bodies apart, or take a stiffer material, a finer mesh or smaller steps");
}

std::vector<SceneFault> findFaults(const SceneWorld& world, const SceneFrames& frames)
{
    return FaultSearch(world, frames).find();
}

}  // namespace bullet_fem

// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "bullet_bridge/joints/welds.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace bullet_fem
{
namespace
{

std::array<int, 3> sorted(std::array<int, 3> face)
{
    std::sort(face.begin(), face.end());
    return face;
}

/// The surface nodes of a body, sorted by x coordinate.
std::vector<std::pair<double, int>> alongX(const FemSoftBody& fem)
{
    std::vector<std::pair<double, int>> nodes;
    for (int node : fem.m_body.m_model->mesh().surfaceNodes()) nodes.emplace_back(fem.m_body.m_state.m_x[node].x, node);
    std::sort(nodes.begin(), nodes.end());
    return nodes;
}

/// Per node of `a`, the nearest surface node of b within reach; -1: none.
std::vector<int> partners(const FemSoftBody& a, const FemSoftBody& b, double reach)
{
    const std::vector<std::pair<double, int>> others = alongX(b);
    std::vector<int> found(a.m_body.m_state.m_x.size(), -1);
    for (int node : a.m_body.m_model->mesh().surfaceNodes())
    {
        const Vec3& x = a.m_body.m_state.m_x[node];
        double nearest = reach;
        const std::pair<double, int> from{x.x - reach, -1};
        for (auto at = std::lower_bound(others.begin(), others.end(), from);
             at != others.end() && at->first <= x.x + reach; ++at)
        {
            const double distance = norm(b.m_body.m_state.m_x[at->second] - x);
            if (distance > nearest) continue;
            nearest = distance;
            found[node] = at->second;
        }
    }
    return found;
}

bool isTieOf(const Weld& weld, const HeldJoint& held, const NodeAttachment& tie)
{
    return held.m_kind == HeldJoint::Kind::attachment && !held.m_isEndB && held.m_id == weld.m_id &&
           held.m_node == tie.m_node && held.m_object == weld.m_other;
}

// Traction by tension and shear [Pa]; compression breaks nothing. `force` acts on the side that the normal points away
// from.
double tractionOf(const Vec3& force, const Vec3& normal, double area)
{
    const double length = norm(normal);
    const Vec3 n = length > 0 ? (1 / length) * normal : Vec3();
    const double pull = dot(force, n);
    const Vec3 bearing = pull > 0 ? force : force - pull * n;
    return norm(bearing) / area;
}

}  // namespace

CommonFaces commonFaces(const FemSoftBody& a, const FemSoftBody& b, double reach)
{
    const std::vector<int> partner = partners(a, b, reach);
    std::vector<std::array<int, 3>> others;
    for (const Triangle& t : b.m_body.m_model->mesh().surface()) others.push_back(sorted(t));
    std::sort(others.begin(), others.end());
    CommonFaces common;
    std::vector<double> area(partner.size(), 0);
    const std::vector<Vec3>& x = a.m_body.m_state.m_x;
    for (const Triangle& t : a.m_body.m_model->mesh().surface())
    {
        const std::array<int, 3> facing = {partner[t[0]], partner[t[1]], partner[t[2]]};
        if (facing[0] < 0 || facing[1] < 0 || facing[2] < 0 ||
            !std::binary_search(others.begin(), others.end(), sorted(facing)))
            continue;
        common.m_faces.push_back(t);
        const double third = norm(cross(x[t[1]] - x[t[0]], x[t[2]] - x[t[0]])) / 6;
        for (int node : t) area[node] += third;
    }
    for (std::size_t i = 0; i < partner.size(); ++i)
    {
        if (!(area[i] > 0)) continue;
        common.m_nodes.emplace_back(static_cast<int>(i), partner[i]);
        common.m_area.push_back(area[i]);
    }
    return common;
}

int addWeld(FemSoftBody& a, const FemSoftBody& b, const CommonFaces& faces, Weld weld, double compliance)
{
    weld.m_id = ++a.m_joints.m_lastId;
    weld.m_other = b.m_softBody;
    weld.m_faces = faces.m_faces;
    for (std::size_t k = 0; k < faces.m_nodes.size(); ++k)
    {
        NodeAttachment tie;
        tie.m_id = weld.m_id;
        tie.m_node = faces.m_nodes[k].first;
        tie.m_other = b.m_softBody;
        tie.m_otherMark = b.m_setUp.m_mark;
        tie.m_otherNodes.fill(faces.m_nodes[k].second);
        tie.m_area = faces.m_area[k];
        tie.m_compliance = compliance / tie.m_area;
        a.m_joints.m_attachments.push_back(tie);
    }
    a.m_joints.m_welds.push_back(std::move(weld));
    a.m_memory.m_place.forget();  // welded surfaces have no contact
    return a.m_joints.m_lastId;
}

int WeldClusters::root(int body) const
{
    while (m_parent[body] != body) body = m_parent[body];
    return body;
}

// Index of an attachment's other body; -1 if it no longer exists.
int WeldClusters::indexOf(const NodeAttachment& tie) const
{
    const int b = m_byAddress.find(tie.m_other);
    return b >= 0 && m_bodies[b]->m_setUp.m_mark == tie.m_otherMark ? b : -1;
}

void WeldClusters::find(const std::vector<FemSoftBody*>& bodies, const std::vector<FemSoftBody*>& others)
{
    m_bodies.assign(bodies.begin(), bodies.end());
    m_bodies.insert(m_bodies.end(), others.begin(), others.end());
    bool any = false;
    for (FemSoftBody* fem : m_bodies)
    {
        fem->m_joints.m_cluster = -1;
        fem->m_joints.m_isWelded.clear();
        any = any || !fem->m_joints.m_welds.empty();
    }
    if (!any) return;
    const int count = static_cast<int>(m_bodies.size());
    m_byAddress.clear();
    m_parent.clear();
    for (int b = 0; b < count; ++b)
    {
        m_byAddress.add(m_bodies[b]->m_softBody, b);
        m_parent.push_back(b);
    }
    const auto mark = [](FemSoftBody& fem, int node)
    {
        if (fem.m_joints.m_isWelded.empty()) fem.m_joints.m_isWelded.assign(fem.m_body.m_state.m_x.size(), 0);
        fem.m_joints.m_isWelded[node] = 1;
    };
    for (int b = 0; b < count; ++b)
        for (const NodeAttachment& tie : m_bodies[b]->m_joints.m_attachments)
        {
            const int other = tie.m_area > 0 ? indexOf(tie) : -1;
            if (other < 0) continue;
            mark(*m_bodies[b], tie.m_node);
            mark(*m_bodies[other], tie.m_otherNodes[0]);
            m_parent[std::max(root(b), root(other))] = std::min(root(b), root(other));
        }
    for (int b = 0; b < count; ++b)
        if (!m_bodies[b]->m_joints.m_isWelded.empty()) m_bodies[b]->m_joints.m_cluster = root(b);
}

bool mayTouch(const FemSoftBody& a, const FemSoftBody& b)
{
    const bool areOne = &a != &b && a.m_joints.m_cluster >= 0 && a.m_joints.m_cluster == b.m_joints.m_cluster;
    const int flags = a.m_softBody->m_cfg.collisions & b.m_softBody->m_cfg.collisions;
    return !areOne || (flags & btSoftBody::fCollision::CL_SELF) != 0;
}

bool areWelded(const FemSoftBody& a, const SurfacePoint& pointOfA, const FemSoftBody& b, const SurfacePoint& pointOfB)
{
    if (a.m_joints.m_cluster < 0 || a.m_joints.m_cluster != b.m_joints.m_cluster) return false;
    const auto has = [](const FemSoftBody& fem, const SurfacePoint& point)
    {
        const auto end = point.m_nodes.begin() + point.m_count;
        return std::any_of(point.m_nodes.begin(), end, [&fem](int node) { return fem.m_joints.m_isWelded[node] != 0; });
    };
    return has(a, pointOfA) && has(b, pointOfB);
}

void WeldLoads::findNormals(const FemSoftBody& fem, const Weld& weld)
{
    const std::vector<Vec3>& x = fem.m_body.m_state.m_x;
    if (m_normal.size() < x.size()) m_normal.resize(x.size());
    for (const std::array<int, 3>& face : weld.m_faces)
        for (int node : face) m_normal[node] = {};
    for (const std::array<int, 3>& face : weld.m_faces)
    {
        const Vec3 normal = cross(x[face[1]] - x[face[0]], x[face[2]] - x[face[0]]);
        for (int node : face) m_normal[node] += normal;
    }
}

const WeldLoad& WeldLoads::load(const FemSoftBody& fem, const Weld& weld, double step)
{
    findNormals(fem, weld);
    m_load = {};
    m_ties.clear();
    const std::vector<HeldJoint>& now = fem.m_joints.m_now;
    std::size_t next = 0;  // both lists have the attachments in one order
    const int count = static_cast<int>(fem.m_joints.m_attachments.size());
    for (int k = 0; k < count; ++k)
    {
        const NodeAttachment& tie = fem.m_joints.m_attachments[k];
        if (tie.m_id != weld.m_id || !(tie.m_area > 0)) continue;
        std::size_t at = next;
        while (at < now.size() && !isTieOf(weld, now[at], tie)) ++at;
        Tie bears = {k, 0, 0};
        if (at < now.size())  // otherwise the attachment is newer than the step
        {
            next = at + 1;
            const Vec3 force = (1 / step) * now[at].m_impulse;
            bears.m_stress = tractionOf(force, m_normal[tie.m_node], tie.m_area);
            bears.m_stretch = now[at].m_error;
            m_load.m_force += force;
        }
        ++m_load.m_nodes;
        m_load.m_area += tie.m_area;
        m_load.m_stress = std::max(m_load.m_stress, bears.m_stress);
        m_load.m_stretch = std::max(m_load.m_stretch, bears.m_stretch);
        m_ties.push_back(bears);
    }
    return m_load;
}

void WeldLoads::breakWelds(FemSoftBody& fem, double step, std::vector<WeldBreak>& broken)
{
    std::vector<Weld>& welds = fem.m_joints.m_welds;
    if (welds.empty()) return;
    std::vector<NodeAttachment>& attachments = fem.m_joints.m_attachments;
    const auto isBroken = [](const NodeAttachment& tie) { return tie.m_id == 0; };
    std::size_t kept = 0;
    for (std::size_t w = 0; w < welds.size(); ++w)
    {
        const Weld& weld = welds[w];
        WeldBreak event = {weld.m_id, weld.m_other, 0, load(fem, weld, step)};
        const bool all = norm(event.m_load.m_force) > weld.m_breakForce;
        for (const Tie& tie : m_ties)
        {
            if (!all && tie.m_stress <= weld.m_breakStress && tie.m_stretch <= weld.m_breakStretch) continue;
            event.m_load.m_area -= attachments[tie.m_index].m_area;
            attachments[tie.m_index].m_id = 0;
            ++event.m_broken;
        }
        event.m_load.m_nodes -= event.m_broken;
        if (event.m_load.m_nodes == 0) event.m_load.m_area = 0;
        if (event.m_broken > 0) broken.push_back(event);
        attachments.erase(std::remove_if(attachments.begin(), attachments.end(), isBroken), attachments.end());
        if (event.m_load.m_nodes == 0) continue;
        if (kept != w) welds[kept] = std::move(welds[w]);
        ++kept;
    }
    welds.resize(kept);
}

}  // namespace bullet_fem

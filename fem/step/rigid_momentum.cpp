// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "fem/step/rigid_momentum.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace bullet_fem
{
namespace
{

// Inverse of an inertia tensor; along axes without inertia (a piece collapsed to a point or a line) it stays bounded.
// What is below `rounding` [kg m2] is none.
Mat3 boundedInverse(const Mat3& inertia, double rounding)
{
    const double size = trace(inertia);
    if (!(size > rounding)) return {};
    return inverse(inertia + Mat3::diagonal(1e-14 * size));
}

// Share of a piece's size by which fixed nodes may lie beside a point or a line.
constexpr double kOnLine = 1e-4;

// Calls add(piece, i) for every node, in order. Nodes of a piece mostly follow each other: what is summed up for such a
// run stays in registers, for additions to memory would wait for one another.
template <class Piece, class Add>
void forEachNode(const std::vector<int>& component, std::vector<Piece>& pieces, const Add& add)
{
    const int n = static_cast<int>(component.size());
    for (int i = 0; i < n;)
    {
        const int c = component[i];
        Piece piece = pieces[c];
        for (; i < n && component[i] == c; ++i) add(piece, i);
        pieces[c] = piece;
    }
}

}  // namespace

void RigidMomentum::prescribe(const Body& body, double step)
{
    const std::vector<int>& component = body.m_model->mesh().nodeComponent();
    const BodyState& s = body.m_state;
    const int n = body.m_model->nodeCount();
    for (Piece& piece : m_pieces) piece = Piece();
    for (int i = 0; i < n; ++i)
        if (s.m_fixed[i]) m_pieces[component[i]].m_free = false;
    m_anyFree = std::any_of(m_pieces.begin(), m_pieces.end(), [](const Piece& piece) { return piece.m_free; });
    if (!m_anyFree) return;
    forEachNode(component, m_pieces,
                [&](Piece& piece, int i)
                {
                    piece.m_mass += s.m_mass[i];
                    piece.m_center += s.m_mass[i] * s.m_x[i];
                });
    for (Piece& piece : m_pieces) piece.m_center *= 1 / piece.m_mass;

    const double alpha = damping(body), toFrame = body.m_loads.m_frameDamping;
    const double share = step / (1 + step * (alpha + toFrame));
    forEachNode(component, m_pieces,
                [&](Piece& piece, int i)
                {
                    const Vec3 r = s.m_x[i] - piece.m_center, p = s.m_mass[i] * s.m_v[i];
                    Vec3 force = body.m_loads.m_force[i] - alpha * p;
                    if (toFrame > 0) force += toFrame * (s.m_mass[i] * body.m_loads.m_frameVelocity[i] - p);
                    const Vec3 prescribed = p + share * force;
                    piece.m_linear += prescribed;
                    piece.m_angular += cross(r, prescribed);
                    piece.m_inverseInertia += s.m_mass[i] * (Mat3::diagonal(dot(r, r)) - outer(r, r));
                });
    for (Piece& piece : m_pieces)
        piece.m_inverseInertia = inverseInertia(piece.m_inverseInertia, piece.m_mass, piece.m_center);
}

double RigidMomentum::damping(const Body& body)
{
    return body.m_model->shape().m_material.m_massDamping + body.m_loads.m_massDamping;
}

Mat3 RigidMomentum::inverseInertia(const Mat3& inertia, double mass, const Vec3& center)
{
    return boundedInverse(inertia, 1e-24 * mass * dot(center, center));
}

RigidMomentum::FreePiece RigidMomentum::onlyPiece() const
{
    const Piece& piece = m_pieces.front();
    return {piece.m_mass, piece.m_center, piece.m_linear, piece.m_angular, piece.m_inverseInertia};
}

void RigidMomentum::setOnlyPiece(const FreePiece& free)
{
    m_anyFree = true;
    Piece& piece = m_pieces.front();
    piece = Piece();
    piece.m_mass = free.m_mass;
    piece.m_center = free.m_center;
    piece.m_linear = free.m_linear;
    piece.m_angular = free.m_angular;
    piece.m_inverseInertia = free.m_inverseInertia;
}

// Centre, mass, inertia and axis of the pieces with fixed nodes, by any of those and the one farthest from it; false if
// there are no such pieces.
bool RigidMomentum::findPivots(const Body& body)
{
    const std::vector<int>& component = body.m_model->mesh().nodeComponent();
    const BodyState& s = body.m_state;
    bool any = false;
    for (Piece& piece : m_pieces)
        if (!piece.m_free) piece = Piece();
    for (std::size_t i = 0; i < s.m_x.size(); ++i)
    {
        Piece& piece = m_pieces[component[i]];
        if (!s.m_fixed[i] || !piece.m_free) continue;
        piece.m_free = false;
        piece.m_center = s.m_x[i];
        any = true;
    }
    for (std::size_t i = 0; i < s.m_x.size(); ++i)
    {
        Piece& piece = m_pieces[component[i]];
        if (piece.m_free) continue;
        const Vec3 r = s.m_x[i] - piece.m_center;
        piece.m_mass += s.m_mass[i];
        piece.m_inverseInertia += s.m_mass[i] * (Mat3::diagonal(dot(r, r)) - outer(r, r));
        if (s.m_fixed[i] && dot(r, r) > dot(piece.m_axis, piece.m_axis)) piece.m_axis = r;
    }
    return any;
}

// A piece is clamped, not hung, if a fixed node lies beside the point or line of the others.
void RigidMomentum::findClamped(const Body& body)
{
    const std::vector<int>& component = body.m_model->mesh().nodeComponent();
    const BodyState& s = body.m_state;
    const auto slack = [](const Piece& piece)
    { return kOnLine * std::sqrt(trace(piece.m_inverseInertia) / piece.m_mass); };
    for (Piece& piece : m_pieces)
    {
        piece.m_hung = !piece.m_free;
        if (piece.m_hung && norm(piece.m_axis) <= slack(piece)) piece.m_axis = {};
    }
    for (std::size_t i = 0; i < s.m_x.size(); ++i)
    {
        Piece& piece = m_pieces[component[i]];
        if (!s.m_fixed[i]) continue;
        const Vec3 r = s.m_x[i] - piece.m_center;
        const double length2 = dot(piece.m_axis, piece.m_axis);
        const Vec3 beside = length2 > 0 ? r - (dot(r, piece.m_axis) / length2) * piece.m_axis : r;
        if (norm(beside) > slack(piece)) piece.m_hung = false;
    }
}

void RigidMomentum::keepHung(const Body& body, const std::vector<Vec3>& velocity)
{
    if (!(body.m_loads.m_frameDamping > 0) || !findPivots(body)) return;
    findClamped(body);
    for (Piece& piece : m_pieces)
    {
        if (!piece.m_hung) continue;
        const double about = dot(piece.m_axis, piece.m_inverseInertia * piece.m_axis);  // it is the inertia so far
        piece.m_inverseInertia =
            about > 0 ? (1 / about) * outer(piece.m_axis, piece.m_axis) : boundedInverse(piece.m_inverseInertia, 0);
        piece.m_mass = std::numeric_limits<double>::infinity();
        piece.m_free = m_anyFree = true;
    }
    const std::vector<int>& component = body.m_model->mesh().nodeComponent();
    const BodyState& s = body.m_state;
    for (std::size_t i = 0; i < s.m_x.size(); ++i)
    {
        Piece& piece = m_pieces[component[i]];
        if (piece.m_hung) piece.m_angular += cross(s.m_x[i] - piece.m_center, s.m_mass[i] * velocity[i]);
    }
}

void RigidMomentum::addImpulses(const Body& body, const std::vector<Vec3>& impulses, double step)
{
    if (!m_anyFree) return;
    const std::vector<int>& component = body.m_model->mesh().nodeComponent();
    const double share = 1 / (1 + step * damping(body));
    for (std::size_t i = 0; i < impulses.size(); ++i)
    {
        Piece& piece = m_pieces[component[i]];
        piece.m_linear += share * impulses[i];
        piece.m_angular += cross(body.m_state.m_x[i] - piece.m_center, share * impulses[i]);
    }
}

void RigidMomentum::addAngularImpulse(const Body& body, int node, const Vec3& impulse, double step)
{
    m_pieces[body.m_model->mesh().nodeComponent()[node]].m_angular += (1 / (1 + step * damping(body))) * impulse;
}

void RigidMomentum::restore(const Body& body, std::vector<Vec3>& velocity)
{
    if (!m_anyFree) return;
    const std::vector<int>& component = body.m_model->mesh().nodeComponent();
    const BodyState& s = body.m_state;
    for (Piece& piece : m_pieces)
    {
        piece.m_linearVelocity = piece.m_linear;
        piece.m_angularVelocity = piece.m_angular;
    }
    forEachNode(component, m_pieces,
                [&](Piece& piece, int i)
                {
                    const Vec3 p = s.m_mass[i] * velocity[i];
                    piece.m_linearVelocity -= p;
                    piece.m_angularVelocity -= cross(s.m_x[i] - piece.m_center, p);
                });
    for (Piece& piece : m_pieces)
    {
        piece.m_linearVelocity *= 1 / piece.m_mass;
        piece.m_angularVelocity = piece.m_inverseInertia * piece.m_angularVelocity;
    }
    forEachNode(component, m_pieces,
                [&](const Piece& piece, int i)
                {
                    if (piece.m_free && !s.m_fixed[i])
                        velocity[i] +=
                            piece.m_linearVelocity + cross(piece.m_angularVelocity, s.m_x[i] - piece.m_center);
                });
}

}  // namespace bullet_fem

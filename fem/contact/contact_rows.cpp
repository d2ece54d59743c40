// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "fem/contact/contact_rows.h"

#include <algorithm>

#include "bullet_fem/fem/stepping.h"
#include "fem/factor/rest_factor.h"
#include "fem/step_scratch.h"
#include "fem/warped_system.h"

namespace bullet_fem
{
namespace
{

// A unit vector at a right angle to n, and n x it.
void makeTangents(const Vec3& n, Vec3 (&t)[2])
{
    const Vec3 axis = std::fabs(n.x) < 0.6 ? Vec3{1, 0, 0} : Vec3{0, 1, 0};
    t[0] = cross(axis, n);
    t[0] *= 1 / norm(t[0]);
    t[1] = cross(n, t[0]);
}

Vec3 scaled(const Vec3& a, const Vec3& b)
{
    return {a.x * b.x, a.y * b.y, a.z * b.z};
}

// Velocity of the obstacle's point for an impulse -J on it, J acting on the soft side: (1/m + I^-1) seen at the arm.
Vec3 obstacleResponse(const Obstacle& obstacle, const Vec3& arm, const Vec3& impulse)
{
    return scaled(obstacle.m_inverseMass, impulse) + cross(obstacle.m_inverseInertia * cross(arm, impulse), arm);
}

constexpr double kTooStiff = 1.1;        // W may be too stiff by this factor before it is scaled
constexpr double kScaleMargin = 1.2;     // for directions that the impulses did not show
constexpr double kLargestScaling = 100;  // in one round
constexpr double kNoise = 1e-4;          // share of all work below which a round's work teaches nothing
constexpr double kForgetting = 0.99;     // of what was learnt, a step

Vec3 softVelocity(const std::vector<ContactBody>& bodies, const ContactPoint& contact)
{
    const std::vector<Vec3>& v = velocity(*bodies[contact.m_body].m_body);
    Vec3 sum;
    for (int a = 0; a < 3; ++a) sum += contact.m_weights[a] * v[contact.m_nodes[a]];
    return sum;
}

void addReaction(Obstacle& obstacle, const Vec3& arm, const Vec3& impulse)
{
    obstacle.m_linearVelocity -= scaled(obstacle.m_inverseMass, impulse);
    obstacle.m_angularVelocity -= obstacle.m_inverseInertia * cross(arm, impulse);
}

}  // namespace

const Mat3& ContactRows::W(int k, int l) const
{
    const int b = m_bodyOfContact[k], first = m_bodyFirst[b], count = m_bodyFirst[b + 1] - first;
    return m_W[m_blockStart[b] + static_cast<std::size_t>(k - first) * count + (l - first)];
}

void ContactRows::assemble(const std::vector<ContactBody>& bodies, const std::vector<Obstacle>& obstacles,
                           const std::vector<ContactPoint>& contacts, const StepSettings& step)
{
    m_step = step.m_step;
    m_rows.resize(contacts.size());
    m_bodyOfContact.resize(contacts.size());
    m_bodyFirst.assign(bodies.size() + 1, static_cast<int>(contacts.size()));
    m_blockStart.assign(bodies.size() + 1, 0);
    for (int k = static_cast<int>(contacts.size()) - 1; k >= 0; --k)
    {
        m_bodyOfContact[k] = contacts[k].m_body;
        m_bodyFirst[contacts[k].m_body] = k;
    }
    for (std::size_t b = bodies.size(); b-- > 0;) m_bodyFirst[b] = std::min(m_bodyFirst[b], m_bodyFirst[b + 1]);
    for (std::size_t b = 0; b < bodies.size(); ++b)
    {
        const std::size_t count = m_bodyFirst[b + 1] - m_bodyFirst[b];
        m_blockStart[b + 1] = m_blockStart[b] + count * count;
    }
    if (m_W.size() < m_blockStart.back()) m_W.resize(m_blockStart.back());
    for (std::size_t b = 0; b < bodies.size(); ++b) assembleBody(bodies[b], static_cast<int>(b), contacts, step.m_warp);
    prepareRows(obstacles, contacts);
}

void ContactRows::prepareRows(const std::vector<Obstacle>& obstacles, const std::vector<ContactPoint>& contacts)
{
    for (std::size_t k = 0; k < contacts.size(); ++k)
    {
        m_rows[k].m_diagonal = W(static_cast<int>(k), static_cast<int>(k));
        prepareRow(obstacles[contacts[k].m_obstacle], contacts[k], m_rows[k]);
    }
}

void ContactRows::assembleBody(const ContactBody& body, int bodyIndex, const std::vector<ContactPoint>& contacts,
                               Warp warp)
{
    const int first = m_bodyFirst[bodyIndex], last = m_bodyFirst[bodyIndex + 1];
    if (first == last) return;
    m_touched.clear();
    for (int k = first; k < last; ++k)
        m_touched.insert(m_touched.end(), contacts[k].m_nodes.begin(), contacts[k].m_nodes.end());
    std::sort(m_touched.begin(), m_touched.end());
    m_touched.erase(std::unique(m_touched.begin(), m_touched.end()), m_touched.end());
    body.m_compliance->request(m_touched);

    const WarpedPreconditioner P(*body.m_body, warp);
    const RestFactor& factor = body.m_body->m_model->factor();
    const std::vector<unsigned char>& fixed = body.m_body->m_state.m_fixed;
    const auto nodeCompliance = [&](int i, int j) -> Mat3
    {
        if (fixed[i] || fixed[j]) return {};
        if (factor.position(i) < 0 || factor.position(j) < 0)
            return i == j ? Mat3::diagonal(1 / factor.diagonal(i)) : Mat3();
        return P.rotation(i) * timesTranspose(body.m_compliance->block(i, j), P.rotation(j));
    };
    double& scale = body.m_body->m_workspace.scratch().m_complianceScale;
    scale = std::max(1.0, kForgetting * scale);
    const int count = last - first;
    Mat3* block = &m_W[m_blockStart[bodyIndex]];
    for (int k = 0; k < count; ++k)
        for (int l = 0; l <= k; ++l)
        {
            const ContactPoint &ck = contacts[first + k], &cl = contacts[first + l];
            Mat3 w;
            for (int a = 0; a < 3; ++a)
                for (int b = 0; b < 3; ++b)
                    if (ck.m_weights[a] != 0 && cl.m_weights[b] != 0)
                        w += scale * ck.m_weights[a] * cl.m_weights[b] * nodeCompliance(ck.m_nodes[a], cl.m_nodes[b]);
            block[static_cast<std::size_t>(k) * count + l] = w;
            block[static_cast<std::size_t>(l) * count + k] = transpose(w);
        }
}

void ContactRows::prepareRow(const Obstacle& obstacle, const ContactPoint& contact, Row& row) const
{
    row.m_arm = contact.m_point - obstacle.m_center;
    Vec3 columns[3];
    for (int c = 0; c < 3; ++c)
    {
        Vec3 unit;
        unit[c] = 1;
        columns[c] = obstacleResponse(obstacle, row.m_arm, unit);
    }
    row.m_diagonal += Mat3::fromColumns(columns[0], columns[1], columns[2]);
    makeTangents(contact.m_normal, row.m_tangent);
    row.m_normalCompliance = dot(contact.m_normal, row.m_diagonal * contact.m_normal);
    const Vec3 Dt0 = row.m_diagonal * row.m_tangent[0], Dt1 = row.m_diagonal * row.m_tangent[1];
    const double a = dot(row.m_tangent[0], Dt0), b = dot(row.m_tangent[1], Dt1), c = dot(row.m_tangent[0], Dt1);
    row.m_tangentCompliance = 0.5 * (a + b) + std::sqrt(0.25 * (a - b) * (a - b) + c * c);
}

void ContactRows::warmStart(const std::vector<ContactPoint>& contacts, std::vector<Obstacle>& obstacles) const
{
    for (std::size_t k = 0; k < contacts.size(); ++k)
        addReaction(obstacles[contacts[k].m_obstacle], m_rows[k].m_arm, contacts[k].m_impulse);
}

void ContactRows::addResponse(int k, const Vec3& impulse)
{
    const int b = m_bodyOfContact[k];
    const int count = m_bodyFirst[b + 1] - m_bodyFirst[b];
    const Mat3* w = &W(k, m_bodyFirst[b]);  // row k is column k transposed
    for (int l = 0; l < count; ++l) m_rows[m_bodyFirst[b] + l].m_velocity += transposeTimes(w[l], impulse);
}

// The rows hold the soft side's velocity alone; the obstacles' own are looked up where a row is solved.
void ContactRows::measureVelocities(const std::vector<ContactBody>& bodies, const std::vector<ContactPoint>& contacts,
                                    const std::vector<Vec3>& applied)
{
    for (std::size_t k = 0; k < contacts.size(); ++k)
        m_rows[k].m_velocity = m_rows[k].m_before = softVelocity(bodies, contacts[k]);
    for (std::size_t k = 0; k < contacts.size(); ++k)
    {
        const Vec3 rest = contacts[k].m_impulse - applied[k];
        if (dot(rest, rest) > 0) addResponse(static_cast<int>(k), rest);
    }
}

double ContactRows::worstViolation(const std::vector<ContactBody>& bodies, const std::vector<Obstacle>& obstacles,
                                   const std::vector<ContactPoint>& contacts) const
{
    double worst = 0;
    for (std::size_t k = 0; k < contacts.size(); ++k)
    {
        const ContactPoint& c = contacts[k];
        if (!(m_rows[k].m_normalCompliance > 0)) continue;
        const Vec3 v = softVelocity(bodies, c) - obstacles[c.m_obstacle].velocityAt(c.m_point);
        worst = std::max(worst, -dot(c.m_normal, v) - std::max(c.m_gap, 0.0) / m_step);
    }
    return worst;
}

void ContactRows::learnCompliance(const std::vector<ContactBody>& bodies, const std::vector<Obstacle>& obstacles,
                                  const std::vector<ContactPoint>& contacts, const std::vector<Vec3>& applied)
{
    bool learned = false;
    for (std::size_t b = 0; b < bodies.size(); ++b)
    {
        double trueWork = 0, predictedWork = 0;  // of the new impulses on the velocities that they made
        double allWork = 0;                      // of all impulses, roughly
        for (int k = m_bodyFirst[b]; k < m_bodyFirst[b + 1]; ++k)
        {
            const Vec3 impulse = contacts[k].m_impulse - applied[k];
            trueWork += dot(impulse, softVelocity(bodies, contacts[k]) - m_rows[k].m_before);
            predictedWork += dot(impulse, m_rows[k].m_velocity - m_rows[k].m_before);
            allWork += dot(contacts[k].m_impulse, m_rows[k].m_diagonal * contacts[k].m_impulse);
        }
        if (!(predictedWork > kNoise * allWork) || !(trueWork > kTooStiff * predictedWork)) continue;
        const double factor = std::min(kScaleMargin * trueWork / predictedWork, kLargestScaling);
        bodies[b].m_body->m_workspace.scratch().m_complianceScale *= factor;
        for (std::size_t i = m_blockStart[b]; i < m_blockStart[b + 1]; ++i) m_W[i] *= factor;
        learned = true;
    }
    if (learned) prepareRows(obstacles, contacts);
}

int ContactRows::sweep(std::vector<Obstacle>& obstacles, std::vector<ContactPoint>& contacts,
                       const ContactSettings& settings)
{
    for (int s = 1; s <= settings.m_sweeps; ++s)
    {
        double largestChange = 0, largest = 0;
        for (std::size_t k = 0; k < contacts.size(); ++k)
        {
            ContactPoint& contact = contacts[k];
            Row& row = m_rows[k];
            Obstacle& obstacle = obstacles[contact.m_obstacle];
            if (!(row.m_normalCompliance > 0)) continue;
            const Vec3 n = contact.m_normal;
            Vec3 v = row.m_velocity - obstacle.velocityAt(contact.m_point);

            // Normal: n . v + max(gap, 0) / h >= 0.
            const double oldNormal = dot(contact.m_impulse, n);
            const double closing = dot(n, v) + std::max(contact.m_gap, 0.0) / m_step;
            const double normal = std::max(0.0, oldNormal - closing / row.m_normalCompliance);
            v += row.m_diagonal * ((normal - oldNormal) * n);

            // Friction: a step along the sliding velocity, projected to the disc of radius mu lambda_n. A scalar
            // compliance makes the impulse opposite to the velocity where it slides.
            Vec3 tangential;
            for (const Vec3& t : row.m_tangent)
                tangential += (dot(contact.m_impulse, t) - dot(v, t) / row.m_tangentCompliance) * t;
            const double radius = contact.m_friction * normal, length = norm(tangential);
            if (length > radius) tangential *= length > 0 ? radius / length : 0;

            const Vec3 impulse = normal * n + tangential, change = impulse - contact.m_impulse;
            const double change2 = dot(change, change);
            largest = std::max(largest, dot(impulse, impulse));
            if (change2 == 0) continue;
            largestChange = std::max(largestChange, change2);
            contact.m_impulse = impulse;
            addResponse(static_cast<int>(k), change);
            addReaction(obstacle, row.m_arm, change);
        }
        if (largestChange <= settings.m_sweepTolerance * settings.m_sweepTolerance * largest) return s;
    }
    return settings.m_sweeps;
}

bool ContactRows::needPush(const std::vector<ContactPoint>& contacts)
{
    return std::any_of(contacts.begin(), contacts.end(), [](const ContactPoint& c) { return c.m_gap < -c.m_slop; });
}

int ContactRows::sweepPush(std::vector<Obstacle>& obstacles, const std::vector<ContactPoint>& contacts,
                           const ContactSettings& settings, std::vector<Vec3>& push)
{
    // Penetrating points shall separate at a share of their depth a step, unless they do so already; the others shall
    // not close their gap. From here on the rows' velocities are by how much more than that they separate.
    push.assign(contacts.size(), Vec3());
    for (std::size_t k = 0; k < contacts.size(); ++k)
    {
        const ContactPoint& c = contacts[k];
        const double moving = dot(c.m_normal, m_rows[k].m_velocity - obstacles[c.m_obstacle].velocityAt(c.m_point));
        const double depth = std::max(0.0, -c.m_gap - c.m_slop);
        const double wanted = std::min(settings.m_pushFraction * depth / m_step, settings.m_maxPushVelocity);
        const double surplus = c.m_gap < 0 ? std::max(moving, 0.0) - wanted : moving + c.m_gap / m_step;
        m_rows[k].m_velocity = surplus * c.m_normal;
    }
    for (int s = 1; s <= settings.m_sweeps; ++s)
    {
        double largestChange = 0, largest = 0;
        for (std::size_t k = 0; k < contacts.size(); ++k)
        {
            const ContactPoint& c = contacts[k];
            Obstacle& obstacle = obstacles[c.m_obstacle];
            if (!(m_rows[k].m_normalCompliance > 0)) continue;
            const Vec3 pushed = obstacle.m_pushLinear + cross(obstacle.m_pushAngular, m_rows[k].m_arm);
            const double missing = dot(c.m_normal, m_rows[k].m_velocity - pushed);
            const double old = dot(push[k], c.m_normal);
            const double normal = std::max(0.0, old - missing / m_rows[k].m_normalCompliance);
            const Vec3 change = (normal - old) * c.m_normal;
            largest = std::max(largest, normal);
            if (normal == old) continue;
            largestChange = std::max(largestChange, std::fabs(normal - old));
            push[k] = normal * c.m_normal;
            addResponse(static_cast<int>(k), change);
            obstacle.m_pushLinear -= scaled(obstacle.m_inverseMass, change);
            obstacle.m_pushAngular -= obstacle.m_inverseInertia * cross(m_rows[k].m_arm, change);
        }
        if (largestChange <= 1e-3 * largest) return s;
    }
    return settings.m_sweeps;
}

}  // namespace bullet_fem

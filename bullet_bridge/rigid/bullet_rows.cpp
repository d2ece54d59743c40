// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "bullet_bridge/rigid/bullet_rows.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "BulletCollision/NarrowPhaseCollision/btManifoldPoint.h"
#include "BulletDynamics/Dynamics/btRigidBody.h"
#include "bullet_fem/bullet_bridge/vectors.h"

namespace bullet_fem
{
namespace
{

constexpr double kBulletUnlimited = 1e30;  // Bullet writes no limit as FLT_MAX or DBL_MAX [N s]
constexpr double kIsotropic = 1e-4;        // deviation of directions of friction from unit vectors that is rounding [-]

// Bullet's rolling friction grows with the normal impulse only up to this one
// (btSequentialImpulseConstraintSolver::solveSingleIteration) [N s].
constexpr double kMaxRollingLoad = 1;

// Added compliance of a joint's rows as a multiple of their own, so that redundant joints share a load: impulses of
// nearly dependent rows would be arbitrary, and thousands of newtons in a bridge with two joints between planks [-].
constexpr double kJointSoftness = 1e-4;

double impulseOf(const btSolverConstraint& row)
{
    return double(btScalar(row.m_appliedImpulse));
}

// Direction of a row between two bodies, on body A; Bullet's is zero for a body that does not move.
Vec3 directionOf(const btSolverConstraint& row)
{
    return row.m_contactNormal1.length2() > 0 ? vec3(row.m_contactNormal1) : -vec3(row.m_contactNormal2);
}

// The target of J v + y lambda beyond J v0 [m/s] or [rad/s]; false if it is not finite.
bool targetBeyond(const btSolverConstraint& row, double& beyond)
{
    const double diagonal = double(row.m_jacDiagABInv);
    beyond = double(row.m_rhs) / diagonal;
    return diagonal > 0 && std::isfinite(beyond) && std::isfinite(double(row.m_cfm));
}

double complianceOf(const btSolverConstraint& row)
{
    return std::max(0.0, double(row.m_cfm) / double(row.m_jacDiagABInv));
}

// Components of the part of a vector in the plane of d and e, which need not be orthogonal.
void split(const Vec3& v, const Vec3& d, const Vec3& e, double& first, double& second)
{
    const double a = dot(d, d), b = dot(d, e), c = dot(e, e), det = a * c - b * b;
    const bool isPlane = det > kIsotropic * a * c;
    first = isPlane ? (c * dot(v, d) - b * dot(v, e)) / det : a > 0 ? dot(v, d) / a : 0;
    second = isPlane ? (a * dot(v, e) - b * dot(v, d)) / det : !(a > 0) && c > 0 ? dot(v, e) / c : 0;
}

Vec3 velocityAt(const Vec3& linear, const Vec3& angular, const Vec3& arm)
{
    return linear + cross(angular, arm);
}

}  // namespace

BulletRows::Side BulletRows::sideOf(const BulletConstraints& bullet, int solverBody,
                                    const std::vector<int>& proxyOf) const
{
    Side side;
    const btSolverBody& body = bullet.m_bodies[solverBody];
    side.m_proxy = proxyOf[solverBody];
    if (!body.m_originalBody) return side;
    side.m_center = vec3(body.m_originalBody->getCenterOfMassPosition());
    side.m_linear = vec3(body.m_linearVelocity) + vec3(body.m_externalForceImpulse);
    side.m_angular = vec3(body.m_angularVelocity) + vec3(body.m_externalTorqueImpulse);
    return side;
}

void BulletRows::append(const BulletConstraints& bullet, const std::vector<int>& proxyOf, ContactProblem& problem)
{
    m_firstContact = problem.m_rigidContacts.size();
    m_firstTorsion = problem.m_torsions.size();
    m_firstJoint = problem.m_joints.size();
    m_firstJacobian = problem.m_jacobians.size();
    m_contacts.clear();
    m_torsions.clear();
    m_axes.clear();
    m_anyBad = false;
    m_contactOf.assign(bullet.m_contacts.size(), -1);
    for (int k = 0; k < bullet.m_bodies.size(); ++k)
    {
        bullet.m_bodies[k].m_deltaLinearVelocity.setZero();
        bullet.m_bodies[k].m_deltaAngularVelocity.setZero();
    }
    for (int k = 0; k < bullet.m_contacts.size(); ++k) appendContact(bullet, k, proxyOf, problem);
    appendTorsions(bullet, proxyOf, problem);
    appendJoints(bullet, proxyOf, problem);
}

void BulletRows::appendContact(const BulletConstraints& bullet, int k, const std::vector<int>& proxyOf,
                               ContactProblem& problem)
{
    const btSolverConstraint& row = bullet.m_contacts[k];
    const btManifoldPoint& point = *static_cast<const btManifoldPoint*>(row.m_originalContactPoint);
    Side first = sideOf(bullet, row.m_solverBodyIdA, proxyOf), second = sideOf(bullet, row.m_solverBodyIdB, proxyOf);
    Vec3 at = vec3(point.getPositionWorldOnA()), atSecond = vec3(point.getPositionWorldOnB());
    Contact contact;
    contact.m_row = k;
    if (first.m_proxy < 0)
    {
        std::swap(first, second);
        std::swap(at, atSecond);
        contact.m_sign = -1;
    }
    double beyond = 0;
    if (first.m_proxy < 0) return;
    const bool isBad = !targetBeyond(row, beyond);
    m_anyBad = m_anyBad || isBad || row.m_cfm < 0;
    if (isBad) return;
    RigidContact touch;
    touch.m_rigidProxy = first.m_proxy;
    touch.m_other = second.m_proxy;
    touch.m_normal = contact.m_sign * vec3(point.m_normalWorldOnB);
    touch.m_arm = at - first.m_center;
    touch.m_otherArm = atSecond - second.m_center;
    const Vec3 ofSecond = velocityAt(second.m_linear, second.m_angular, touch.m_otherArm);
    const Vec3 relative = velocityAt(first.m_linear, first.m_angular, touch.m_arm) - ofSecond;
    touch.m_leastSpeed = beyond + dot(touch.m_normal, relative);
    touch.m_gap = double(point.getDistance());
    if (second.m_proxy < 0) touch.m_otherVelocity = ofSecond;
    touch.m_isSupport = second.m_proxy < 0 && dot(ofSecond, ofSecond) == 0;
    touch.m_compliance = complianceOf(row);
    touch.m_impulse = impulseOf(row) * touch.m_normal;
    setFriction(bullet, row, contact, touch);
    m_contactOf[k] = static_cast<int>(m_contacts.size());
    m_contacts.push_back(contact);
    problem.m_rigidContacts.push_back(touch);
}

// The cone for Bullet's pyramid. Directions d of anisotropic friction, no unit vectors, span an ellipse, whose axes are
// the eigenvectors of d1 d1^T + d2 d2^T. Belts run with the motion that a program gave the contact point; if that is
// not finite, there is no friction.
void BulletRows::setFriction(const BulletConstraints& bullet, const btSolverConstraint& row, Contact& contact,
                             RigidContact& touch) const
{
    const btManifoldPoint& point = *static_cast<const btManifoldPoint*>(row.m_originalContactPoint);
    touch.m_friction = std::max(0.0, double(row.m_friction));
    if (row.m_frictionIndex + 1 >= bullet.m_friction.size()) return;
    // Bullet scales directions along the axes of bodies, which may tilt them out of the tangent plane.
    const auto tangential = [&touch](const Vec3& v) { return v - dot(v, touch.m_normal) * touch.m_normal; };
    const Vec3 d = tangential(directionOf(bullet.m_friction[row.m_frictionIndex])),
               e = tangential(directionOf(bullet.m_friction[row.m_frictionIndex + 1]));
    const Vec3 motion = double(point.m_contactMotion1) * d + double(point.m_contactMotion2) * e;
    if (!isFinite(motion))
    {
        touch.m_friction = 0;
        return;
    }
    contact.m_first = d;
    contact.m_second = e;
    if (impulseOf(row) > 0)
        touch.m_impulse +=
            contact.m_sign * (double(point.m_appliedImpulseLateral1) * d + double(point.m_appliedImpulseLateral2) * e);
    touch.m_otherVelocity += contact.m_sign * motion;
    const double a = dot(d, d), b = dot(d, e), c = dot(e, e);
    if (std::fabs(a - 1) < kIsotropic && std::fabs(c - 1) < kIsotropic && std::fabs(b) < kIsotropic) return;
    // Larger eigenvalue of the Gram matrix; its eigenvector combines d and e to the larger semi-axis.
    const double half = 0.5 * (a - c), most = 0.5 * (a + c) + std::hypot(half, b);
    const double least = std::max(0.0, a + c - most);
    const Vec3 axis = half >= 0 ? (most - c) * d + b * e : b * d + (most - a) * e;
    if (!(norm(axis) > 0))
    {
        touch.m_friction = most > 0 ? std::sqrt(most) * touch.m_friction : 0;
        return;
    }
    touch.m_friction *= std::sqrt(most);
    touch.m_aspect = std::sqrt(least / most);
    touch.m_slipAxis = (1 / norm(axis)) * axis;
}

// The rows of one contact are consecutive: about its normal, then about tangents.
void BulletRows::appendTorsions(const BulletConstraints& bullet, const std::vector<int>& proxyOf,
                                ContactProblem& problem)
{
    const int count = bullet.m_torsions.size();
    for (int begin = 0, end = 0; begin < count; begin = end)
    {
        const int contact = bullet.m_torsions[begin].m_frictionIndex;
        while (end < count && bullet.m_torsions[end].m_frictionIndex == contact) ++end;
        if (m_contactOf[contact] < 0) continue;
        RigidContact& touch = problem.m_rigidContacts[m_firstContact + m_contactOf[contact]];
        TorsionalFriction torsion;
        torsion.m_body = -1;
        torsion.m_firstRigidProxy = touch.m_rigidProxy;
        torsion.m_rigidProxy = touch.m_other;
        torsion.m_maxLoad = kMaxRollingLoad;
        torsion.m_lever = norm(touch.m_arm);
        torsion.m_axes[0] = touch.m_normal;
        torsion.m_friction.x = double(bullet.m_torsions[begin].m_friction);
        Vec3 tangent = cross(std::fabs(touch.m_normal.x) < 0.6 ? Vec3{1, 0, 0} : Vec3{0, 1, 0}, touch.m_normal);
        for (int k = begin + 1; k < std::min(end, begin + 3); ++k)
        {
            const Vec3 axis = vec3(bullet.m_torsions[k].m_relpos2CrossNormal);
            if (k == begin + 1) tangent = axis - dot(axis, touch.m_normal) * touch.m_normal;
            torsion.m_friction[k - begin] = norm(axis) * double(bullet.m_torsions[k].m_friction);
        }
        if (!(norm(tangent) > 0)) continue;
        torsion.m_axes[1] = (1 / norm(tangent)) * tangent;
        torsion.m_axes[2] = cross(torsion.m_axes[0], torsion.m_axes[1]);
        const btSolverConstraint& row = bullet.m_torsions[begin];
        const int other =
            touch.m_rigidProxy == proxyOf[row.m_solverBodyIdA] ? row.m_solverBodyIdB : row.m_solverBodyIdA;
        if (touch.m_other < 0) torsion.m_spin = sideOf(bullet, other, proxyOf).m_angular;
        touch.m_torsion = static_cast<int>(problem.m_torsions.size());
        problem.m_torsions.push_back(torsion);
        m_torsions.push_back({begin, end - begin, m_contacts[m_contactOf[contact]].m_sign});
    }
}

// Up to three consecutive rows of a constraint with equal compliance form a joint.
void BulletRows::appendJoints(const BulletConstraints& bullet, const std::vector<int>& proxyOf, ContactProblem& problem)
{
    int axis = 0;
    const btSolverConstraint* last = nullptr;
    for (int k = 0; k < bullet.m_joints.size(); ++k)
    {
        const btSolverConstraint& row = bullet.m_joints[k];
        const Side a = sideOf(bullet, row.m_solverBodyIdA, proxyOf), b = sideOf(bullet, row.m_solverBodyIdB, proxyOf);
        if (a.m_proxy < 0 && b.m_proxy < 0) continue;
        double beyond = 0;
        const bool isBad = !targetBeyond(row, beyond) || !(row.m_lowerLimit <= row.m_upperLimit);
        m_anyBad = m_anyBad || row.m_cfm < 0 || (isBad && row.m_jacDiagABInv != 0);
        if (isBad) continue;
        const bool continues = last && axis < 3 && last->m_originalContactPoint == row.m_originalContactPoint &&
                               complianceOf(*last) == complianceOf(row);
        if (!continues)
        {
            axis = 0;
            Joint joint;
            joint.m_limit = {};
            joint.m_compliance = complianceOf(row);
            joint.m_softness = kJointSoftness;
            joint.m_a.m_rigidProxy = a.m_proxy;
            joint.m_b.m_rigidProxy = b.m_proxy;
            joint.m_a.m_jacobian = static_cast<int>(problem.m_jacobians.size());
            joint.m_b.m_jacobian = joint.m_a.m_jacobian + 1;
            problem.m_jacobians.resize(problem.m_jacobians.size() + 2);
            problem.m_joints.push_back(joint);
        }
        Joint& joint = problem.m_joints.back();
        Axis of = {k, static_cast<int>(problem.m_joints.size() - 1), axis, 1};
        const bool isTurned = -row.m_lowerLimit > row.m_upperLimit;
        double upper = double(isTurned ? -row.m_lowerLimit : row.m_upperLimit);
        double lower = double(isTurned ? -row.m_upperLimit : row.m_lowerLimit);
        if (upper >= kBulletUnlimited) upper = Joint::kUnlimited;
        if (lower <= -kBulletUnlimited) lower = -Joint::kUnlimited;
        if (isTurned) of.m_sign = -1;
        const Vec3 linearA = vec3(row.m_contactNormal1), angularA = vec3(row.m_relpos1CrossNormal);
        const Vec3 linearB = vec3(row.m_contactNormal2), angularB = vec3(row.m_relpos2CrossNormal);
        double target = beyond;
        if (a.m_proxy >= 0) target += dot(linearA, a.m_linear) + dot(angularA, a.m_angular);
        if (b.m_proxy >= 0) target += dot(linearB, b.m_linear) + dot(angularB, b.m_angular);
        joint.m_wanted[axis] = of.m_sign * target;
        joint.m_limit[axis] = upper;
        joint.m_lower[axis] = lower;
        RigidJacobian &ofA = problem.m_jacobians[joint.m_a.m_jacobian],
                      &ofB = problem.m_jacobians[joint.m_b.m_jacobian];
        for (int i = 0; i < 3; ++i)
        {
            ofA.m_linear(axis, i) = of.m_sign * linearA[i];
            ofA.m_angular(axis, i) = of.m_sign * angularA[i];
            ofB.m_linear(axis, i) = -of.m_sign * linearB[i];
            ofB.m_angular(axis, i) = -of.m_sign * angularB[i];
        }
        m_axes.push_back(of);
        last = &row;
        ++axis;
    }
}

void BulletRows::takeBack(const BulletConstraints& bullet, ContactProblem& problem)
{
    for (std::size_t k = 0; k < m_contacts.size(); ++k)
    {
        const Contact& contact = m_contacts[k];
        const RigidContact& touch = problem.m_rigidContacts[m_firstContact + k];
        const Vec3 onA = contact.m_sign * touch.m_impulse;
        btSolverConstraint& row = bullet.m_contacts[contact.m_row];
        row.m_appliedImpulse = btScalar(dot(touch.m_impulse, touch.m_normal));
        if (row.m_frictionIndex + 1 >= bullet.m_friction.size()) continue;
        double first = 0, second = 0;
        split(onA, contact.m_first, contact.m_second, first, second);
        bullet.m_friction[row.m_frictionIndex].m_appliedImpulse = btScalar(first);
        bullet.m_friction[row.m_frictionIndex + 1].m_appliedImpulse = btScalar(second);
    }
    for (std::size_t k = 0; k < m_torsions.size(); ++k)
    {
        const Vec3 onA = m_torsions[k].m_sign * problem.m_torsions[m_firstTorsion + k].m_impulse;
        for (int r = m_torsions[k].m_first; r < m_torsions[k].m_first + m_torsions[k].m_count; ++r)
        {
            btSolverConstraint& row = bullet.m_torsions[r];
            const Vec3 axis = vec3(row.m_relpos1CrossNormal);
            row.m_appliedImpulse = btScalar(dot(axis, axis) > 0 ? dot(onA, axis) / dot(axis, axis) : 0);
        }
    }
    for (const Axis& axis : m_axes)
        bullet.m_joints[axis.m_row].m_appliedImpulse =
            btScalar(axis.m_sign * problem.m_joints[axis.m_joint].m_impulse[axis.m_axis]);
    problem.m_rigidContacts.resize(m_firstContact);
    problem.m_torsions.resize(m_firstTorsion);
    problem.m_joints.resize(m_firstJoint);
    problem.m_jacobians.resize(m_firstJacobian);
}

}  // namespace bullet_fem

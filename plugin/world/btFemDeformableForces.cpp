// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "plugin/world/btFemDeformableForces.h"

#include <algorithm>
#include <cmath>

#include "bullet_fem/btFemVectors.h"
#include "bullet_fem/fem/mesh/material.h"
#include "plugin/record/btFemArrays.h"

using namespace bullet_fem;

namespace
{

using Force = btDeformableLagrangianForce;

bool isElastic(Force& force)
{
    const btDeformableLagrangianForceType type = force.getForceType();
    return type == BT_LINEAR_ELASTICITY_FORCE || type == BT_COROTATED_FORCE || type == BT_NEOHOOKEAN_FORCE;
}

// True for forces that act on the nodes as Bullet computes them; the others are handled separately or ignored.
bool isExternal(Force& force)
{
    return !isElastic(force) && force.getForceType() != BT_GRAVITY_FORCE && force.getForceType() != BT_MASSSPRING_FORCE;
}

struct Elasticity
{
    LameModuli m_moduli;
    double m_massDamping = 0;
    double m_damping = 0;  // stiffness damping: viscous over elastic moduli
};

Elasticity elasticityOf(Force& force)
{
    switch (force.getForceType())
    {
        case BT_LINEAR_ELASTICITY_FORCE:
        {
            const auto& f = static_cast<btDeformableLinearElasticityForce&>(force);
            return {{f.m_mu, f.m_lambda}, f.m_damping_alpha, f.m_damping_beta};
        }
        case BT_NEOHOOKEAN_FORCE:
        {
            const auto& f = static_cast<btDeformableNeoHookeanForce&>(force);
            return {{f.m_mu, f.m_lambda}, 0, f.m_mu > 0 ? f.m_mu_damp / double(f.m_mu) : 0};
        }
        case BT_COROTATED_FORCE:
        {
            const auto& f = static_cast<btDeformableCorotatedForce&>(force);
            return {{f.m_mu, f.m_lambda}, 0, 0};
        }
        default:
            return {};
    }
}

void clear(btAlignedObjectArray<btVector3>& values, int size)
{
    values.resizeNoInitialize(size);
    for (int i = 0; i < size; ++i) values[i].setZero();
}

}  // namespace

bool btFemForceMaterial::operator==(const btFemForceMaterial& b) const
{
    const auto same = [](btScalar x, btScalar y) { return x == y || (x != x && y != y); };  // both NaN
    const btFemMaterial &p = m_material, &q = b.m_material;
    return m_given == b.m_given && same(p.m_youngModulus, q.m_youngModulus) &&
           same(p.m_poissonRatio, q.m_poissonRatio) && same(p.m_massDamping, q.m_massDamping) &&
           same(p.m_stiffnessDamping, q.m_stiffnessDamping) && p.m_meanDilatation == q.m_meanDilatation &&
           p.m_law == q.m_law;
}

btFemForceMaterial btFemDeformableForces::materialOf(const btSoftBody& body) const
{
    LameModuli sum;
    double massDamping = 0, viscosity = 0;
    btFemForceMaterial result;
    for (int k = 0; k < m_all.size(); ++k)
    {
        if (!isElastic(*m_all[k]) || !btFemHolds(m_all[k]->m_softBodies, &body)) continue;
        const Elasticity part = elasticityOf(*m_all[k]);
        sum += part.m_moduli;
        massDamping += part.m_massDamping;
        viscosity += part.m_damping * part.m_moduli.m_mu;
        result.m_given = true;
        if (m_all[k]->getForceType() == BT_NEOHOOKEAN_FORCE) result.m_material.m_law = btFemElasticLaw::neoHooke;
    }
    if (!result.m_given) return result;
    btFemMaterial& material = result.m_material;
    material.m_youngModulus = static_cast<btScalar>(sum.youngModulus());
    material.m_poissonRatio = static_cast<btScalar>(sum.poissonRatio());
    material.m_density = 0;
    material.m_massDamping = static_cast<btScalar>(massDamping);
    material.m_stiffnessDamping = static_cast<btScalar>(viscosity / sum.m_mu);
    material.m_bending = btFemBending::plain;  // the element of Bullet's forces
    return result;
}

Vec3 btFemDeformableForces::gravityOf(const btSoftBody& body) const
{
    Vec3 sum;
    for (int k = 0; k < m_all.size(); ++k)
        if (m_all[k]->getForceType() == BT_GRAVITY_FORCE && btFemHolds(m_all[k]->m_softBodies, &body))
            sum += vec3(static_cast<const btDeformableGravityForce*>(m_all[k])->m_gravity);
    return double(body.m_gravityFactor) * sum;
}

void btFemDeformableForces::hide(const Bodies& bodies, btAlignedObjectArray<Force*>& left)
{
    left.resizeNoInitialize(0);
    for (int k = 0; k < m_all.size(); ++k)
    {
        Bodies& all = m_all[k]->m_softBodies;
        int kept = 0;
        for (int i = 0; i < all.size(); ++i)
            if (btFemHolds(bodies, all[i]))
                m_hidden.push_back({m_all[k], all[i]});
            else
                all[kept++] = all[i];
        all.resizeNoInitialize(kept);
        const auto isOurs = [&](const Hidden& h) { return h.m_force == m_all[k]; };
        const bool staysWithin = kept > 0 && !isExternal(*m_all[k]);  // others may act on nodes of any body
        if (staysWithin || std::none_of(m_hidden.begin(), m_hidden.end(), isOurs)) left.push_back(m_all[k]);
    }
}

void btFemDeformableForces::show(const Bodies& world)
{
    for (const Hidden& hidden : m_hidden)
        if (btFemHolds(m_all, hidden.m_force) && btFemHolds(world, hidden.m_body) &&
            !btFemHolds(hidden.m_force->m_softBodies, hidden.m_body))
            hidden.m_force->m_softBodies.push_back(hidden.m_body);
    m_hidden.clear();
}

void btFemDeformableForces::addTo(const Bodies& fem, const Bodies& plain, double step)
{
    m_drawn.clear();
    const auto acts = [](const Hidden& h) { return isExternal(*h.m_force); };
    if (std::none_of(m_hidden.begin(), m_hidden.end(), acts)) return;
    int size = 0;
    for (int b = 0; b < plain.size(); ++b) size += plain[b]->m_nodes.size();
    m_place.resizeNoInitialize(0);
    for (int b = 0; b < fem.size(); ++b)
        for (int i = 0; i < fem[b]->m_nodes.size(); ++i)
        {
            btSoftBody::Node& node = fem[b]->m_nodes[i];
            node.index = size++;
            m_place.push_back(node.m_q);
            node.m_q =
                node.m_x;  // Bullet's functions read positions from m_q, which still has those of the previous step
        }
    for (int k = 0; k < m_all.size(); ++k)
    {
        if (!isExternal(*m_all[k]) || !evaluate(*m_all[k], size, step)) continue;
        if (m_all[k]->getForceType() == BT_MOUSE_PICKING_FORCE) takeDrawn(k, fem, step);
        for (int b = 0; b < fem.size(); ++b)
            for (int i = 0; i < fem[b]->m_nodes.size(); ++i)
                fem[b]->m_nodes[i].m_f += (1 / btScalar(step)) * yieldingImpulse(fem[b]->m_nodes[i], step);
        for (int b = 0; b < plain.size(); ++b)
            for (int i = 0; i < plain[b]->m_nodes.size(); ++i)
            {
                btSoftBody::Node& node = plain[b]->m_nodes[i];
                node.m_v += node.m_im * yieldingImpulse(node, step);
            }
    }
    int next = 0;
    for (int b = 0; b < fem.size(); ++b)
        for (int i = 0; i < fem[b]->m_nodes.size(); ++i)
        {
            fem[b]->m_nodes[i].m_q = m_place[next++];
            fem[b]->m_nodes[i].index = 0;
        }
}

// Impulse, stiffness and damping at all nodes; false if the force acts on none of our bodies.
bool btFemDeformableForces::evaluate(Force& force, int size, double step)
{
    m_others.copyFromArray(force.m_softBodies);
    for (const Hidden& hidden : m_hidden)
        if (hidden.m_force == &force) force.m_softBodies.push_back(hidden.m_body);
    const bool ours = force.m_softBodies.size() > m_others.size();
    if (ours)
    {
        for (auto* values : {&m_impulse, &m_stiffness, &m_damping, &m_direction}) clear(*values, size);
        force.addScaledForces(static_cast<btScalar>(step), m_impulse);
    }
    for (int c = 0; c < 3 && ours; ++c)
    {
        for (int i = 0; i < size; ++i) m_direction[i].setZero(), m_direction[i][c] = 1;
        clear(m_change, size);
        force.addScaledElasticForceDifferential(1, m_direction, m_change);
        for (int i = 0; i < size; ++i) m_stiffness[i][c] = m_change[i][c];
        clear(m_change, size);
        force.addScaledDampingForceDifferential(1, m_direction, m_change);
        for (int i = 0; i < size; ++i) m_damping[i][c] = m_change[i][c];
    }
    force.m_softBodies.copyFromArray(m_others);
    return ours;
}

// Takes the elastic part of mouse picking as springs, which are solved with the body: an explicit force would
// overshoot, and the scalar bound of yieldingImpulse() would weaken the hold. The target is the end of the force's
// pull. If the pull is at Bullet's limit, an impulse per step, the target lies farther away and is searched for.
void btFemDeformableForces::takeDrawn(int number, const Bodies& fem, double step)
{
    constexpr double kRounding = 1e-5;  // rounding error of a position in single precision [-]
    Force& force = *m_all[number];
    const std::size_t first = m_drawn.size();
    clear(m_change, m_impulse.size());
    force.addScaledExplicitForce(static_cast<btScalar>(step), m_change);
    for (int b = 0; b < fem.size(); ++b)
        for (int i = 0; i < fem[b]->m_nodes.size(); ++i)
        {
            btSoftBody::Node& node = fem[b]->m_nodes[i];
            const Vec3 pull = vec3(m_change[node.index]);  // in the step [N s]
            NodeSpring spring;
            spring.m_stiffness = stiffnessOf(node);
            if (!(spring.m_stiffness > 0) || !isFinite(pull)) continue;
            spring.m_id = -(number * fem[b]->m_nodes.size() + i + 1);
            spring.m_nodes[0] = i;
            spring.m_target = vec3(node.m_x) + (1 / (step * spring.m_stiffness)) * pull;
            m_impulse[node.index] -= m_change[node.index];
            m_stiffness[node.index].setZero();
            m_drawn.push_back({fem[b], spring});
        }
    for (std::size_t k = first; k < m_drawn.size(); ++k)
    {
        NodeSpring& spring = m_drawn[k].m_spring;
        // The body is one of `fem`, whose nodes may be written.
        btSoftBody::Node& node = const_cast<btSoftBody*>(m_drawn[k].m_body)->m_nodes[spring.m_nodes[0]];
        const Vec3 way = spring.m_target - vec3(node.m_x);
        const Vec3 left = wayLeft(force, node, spring, step);
        if (norm(left) > 1e-3 * norm(way) + kRounding * norm(spring.m_target)) findMouse(force, node, spring, step);
        node.m_q = node.m_x;
    }
}

// Remaining pull of the force with the node at the spring's target [m], limited as in Bullet.
Vec3 btFemDeformableForces::wayLeft(Force& force, btSoftBody::Node& node, const NodeSpring& spring, double step)
{
    node.m_q = bulletVector(spring.m_target);
    clear(m_change, m_impulse.size());
    force.addScaledExplicitForce(static_cast<btScalar>(step), m_change);
    return (1 / (step * spring.m_stiffness)) * vec3(m_change[node.index]);
}

// Searches for the mouse along the pull, whose direction alone is known: doubles the distance until the mouse is
// passed, then bisects.
void btFemDeformableForces::findMouse(Force& force, btSoftBody::Node& node, NodeSpring& spring, double step)
{
    constexpr double kFarthest = 1e6;  // [m]
    const Vec3 x = vec3(node.m_x), limit = spring.m_target - x;
    const double length = norm(limit);
    spring.m_maxForce = spring.m_stiffness * length;
    double before = 1, beyond = 0;  // bounds of the mouse's distance in units of `length`; 0: not known yet
    for (int k = 0; k < 100 && before * length < kFarthest; ++k)
    {
        const double middle = beyond > 0 ? 0.5 * (before + beyond) : 2 * before;
        spring.m_target = x + middle * limit;
        const Vec3 left = wayLeft(force, node, spring, step);
        if (norm(left) < 0.999 * length)
        {
            spring.m_target += left;
            return;
        }
        (dot(left, limit) > 0 ? before : beyond) = middle;
    }
}

// Isotropic stiffness of the force at a node [N/m].
double btFemDeformableForces::stiffnessOf(const btSoftBody::Node& node) const
{
    const btVector3& k = m_stiffness[node.index];
    return std::max(0.0, -(double(k.x()) + double(k.y()) + double(k.z())) / 3);
}

// Implicit Euler for every node alone: m dv = h f(x + h (v + dv), v + dv). Coupling with other nodes only adds
// stability. Damping may act in one direction only, hence the sum.
btVector3 btFemDeformableForces::yieldingImpulse(const btSoftBody::Node& node, double step) const
{
    const auto sum = [](const btVector3& v) { return double(v.x()) + double(v.y()) + double(v.z()); };
    const Vec3 impulse = vec3(m_impulse[node.index]);
    if (node.m_im == 0 || dot(impulse, impulse) == 0) return btVector3(0, 0, 0);
    const double damping = std::max(0.0, -sum(m_damping[node.index]));
    const double yields = 1 + step * (damping + step * stiffnessOf(node)) * double(node.m_im);
    return bulletVector((1 / yields) * impulse);
}

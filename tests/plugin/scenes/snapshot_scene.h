// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <cstdint>
#include <cstring>
#include <vector>

#include "bridge/concave_test_shapes.h"
#include "plugin/scenes/bullet_state.h"
#include "plugin/scenes/scene_measures.h"
#include "plugin/scenes/soft_boxes.h"

namespace bullet_fem
{

/// FEM bodies in all kinds of contact, with rigid ones that have no contacts among themselves: a tower of two soft
/// boxes and a pushed rigid one; a soft box that slides down a slope; one that falls on a triangle mesh; one that is
/// pinned at one end, has node targets at the other, and carries a rigid box; two that are attached to each other.
class SnapshotScene
{
public:
    explicit SnapshotScene(Coupling coupling = Coupling::swap, const btFemSolverInfo& info = {},
                           WorldClass worldClass = WorldClass::softRigid)
        : m_ground(makeTriangleMesh()), m_world(worldClass, coupling, {0, 0, btScalar(-kGravity)}, info)
    {
    }

    void build()
    {
        addTower();
        addSlope();
        addBeam();
        addMesh();
        addCouple();
    }

    void addTower()
    {
        m_world.addPlane();
        add({{1, 1, 0.5}, {4, 4, 2}, {0, 0, 0.26}});
        add({{0.8, 0.8, 0.5}, {3, 3, 2}, {0.1, 0, 0.8}, btScalar(3e5)});
        RigidSettings box{btScalar(60), at(btScalar(0.1), btScalar(0.05), btScalar(1.3))};
        box.m_velocity = {btScalar(0.3), btScalar(0.1), 0};
        box.m_spin = {0, 0, btScalar(0.5)};
        m_rigid.push_back(&addRigidBox(m_world, {0.5, 0.4, 0.3}, box));
    }

    /// A slab with a box on one half, and a light box that settles slowly on the other after some 4.2 s.
    void addSlab()
    {
        m_world.addPlane();
        add({{2, 0.8, 0.4}, {8, 3, 2}, {0, 0, 0.205}});
        m_rigid.push_back(
            &addRigidBox(m_world, {0.3, 0.3, 0.3}, {btScalar(30), at(btScalar(-0.6), 0, btScalar(0.57))}));
        m_rigid.push_back(&addRigidBox(m_world, {0.3, 0.3, 0.3}, {btScalar(20), at(btScalar(0.6), 0, btScalar(3.2))}));
        m_rigid.back()->setGravity({0, 0, btScalar(-0.3)});
    }

    void addSlope()
    {
        RigidSettings slope;
        slope.m_transform =
            btTransform(btQuaternion(btVector3(0, 1, 0), btScalar(0.4)), btVector3(6, 0, btScalar(0.5)));
        addRigidBox(m_world, {6, 2, 0.2}, slope);
        btSoftBody& box = add({{0.5, 0.5, 0.3}, {3, 3, 2}, {0, 0, 0}, btScalar(5e5), 1000, btScalar(0.3)});
        box.transform(slope.m_transform * at(-1, 0, btScalar(0.27)));
    }

    void addBeam()
    {
        btSoftBody& beam = add({{1.6, 0.4, 0.4}, {8, 2, 2}, {-5, 0, 3}});
        for (int i = 0; i < beam.m_nodes.size(); ++i)
            if (beam.m_nodes[i].m_x.x() < btScalar(-5.79)) beam.setMass(i, 0);
        m_fem.prepare(&beam, kStep);
        m_fem.setNodeTarget(&beam, beam.m_nodes.size() - 1,
                            beam.m_nodes[beam.m_nodes.size() - 1].m_x + btVector3(0, 0, 1));
        btRigidBody& weight =
            addRigidBox(m_world, {0.3, 0.3, 0.3}, {btScalar(30), at(btScalar(-4.6), 0, btScalar(2.4))});
        m_rigid.push_back(&weight);
        for (int i = 0; i < beam.m_nodes.size(); ++i)
            if (std::abs(beam.m_nodes[i].m_x.x() + btScalar(4.6)) < btScalar(0.05) &&
                beam.m_nodes[i].m_x.z() < btScalar(2.81))
                beam.appendAnchor(i, &weight);
    }

    void addMesh()
    {
        RigidSettings ground;
        ground.m_transform = at(0, 8, 0);
        std::vector<std::unique_ptr<btCollisionShape>>& parts = m_ground.m_parts;
        btCollisionShape* shape = parts.back().release();
        parts.pop_back();
        m_world.addRigid(shape, ground);
        add({{0.6, 0.6, 0.4}, {3, 3, 2}, {0, 8, 0.4}, btScalar(2e5)});
    }

    void addCouple()
    {
        btSoftBody& a = add({{0.5, 0.5, 0.5}, {2, 2, 2}, {0, -6, 0.3}});
        btSoftBody& b = add({{0.4, 0.4, 0.4}, {2, 2, 2}, {0.7, -6, 1.2}});
        m_fem.prepare(&a, kStep);
        m_fem.prepare(&b, kStep);
        m_fem.attachNodes(&a, a.m_nodes.size() - 1, &b, 0);
    }

    btSoftBody& add(const SoftBox& box)
    {
        m_soft.push_back(&addSoftBox(m_world, m_fem, box));
        return *m_soft.back();
    }

    void setState(int activationState)
    {
        for (btSoftBody* body : m_soft) body->forceActivationState(activationState);
        for (btRigidBody* body : m_rigid) body->forceActivationState(activationState);
    }

    /// Bits of the whole visible state: nodes, rigid bodies, sleep, contacts, touches, anchors.
    void record(std::vector<double>& bits) const
    {
        const auto add = [&bits](const btVector3& v) {
            bits.insert(bits.end(), {double(v[0]), double(v[1]), double(v[2])});
        };
        for (const btSoftBody* body : m_soft)
        {
            for (int i = 0; i < body->m_nodes.size(); ++i)
                for (const btVector3& v : {body->m_nodes[i].m_x, body->m_nodes[i].m_v, body->m_nodes[i].m_n}) add(v);
            const auto& contacts = m_fem.contacts(body);
            for (int k = 0; k < contacts.size(); ++k) add(contacts[k].m_impulse), add(contacts[k].m_point);
            const auto& touches = m_fem.touches(body);
            for (int k = 0; k < touches.size(); ++k)
                add(touches[k].m_impulse), bits.push_back(double(touches[k].m_state));
            const auto& anchors = m_fem.anchors(body);
            for (int k = 0; k < anchors.size(); ++k)
                add(anchors[k].m_impulse), bits.push_back(double(anchors[k].m_error));
            const btFemStepReport& report = m_fem.stepReport(body);
            bits.insert(bits.end(), {double(report.m_flags), double(report.m_iterations), double(report.m_residual)});
            bits.push_back(body->getActivationState());
            bits.push_back(double(body->getDeactivationTime()));
        }
        for (const btRigidBody* body : m_rigid)
        {
            const btMatrix3x3& basis = body->getWorldTransform().getBasis();
            for (const btVector3& v : {basis[0], basis[1], basis[2], body->getWorldTransform().getOrigin(),
                                       body->getLinearVelocity(), body->getAngularVelocity()})
                add(v);
            bits.push_back(body->getActivationState());
        }
    }

    std::vector<double> state() const
    {
        std::vector<double> bits;
        record(bits);
        return bits;
    }

    /// The states after each of `steps` steps.
    std::vector<double> run(int steps, btScalar h = kStep)
    {
        std::vector<double> bits;
        for (int k = 0; k < steps; ++k)
        {
            m_world.step(1, h);
            record(bits);
        }
        return bits;
    }

    std::vector<unsigned char> save() const
    {
        std::vector<unsigned char> buffer;
        m_fem.saveState(buffer);
        return buffer;
    }

    /// Bullet's and this library's parts of a state.
    struct Saved
    {
        BulletState m_bullet;
        std::vector<unsigned char> m_fem;
    };
    Saved saveAll() { return {BulletState(m_world), save()}; }
    void restore(const Saved& saved)
    {
        saved.m_bullet.restore(m_world);
        m_fem.restoreState(saved.m_fem.data(), saved.m_fem.size());
    }

    int contacts() const
    {
        int sum = 0;
        for (const btSoftBody* body : m_soft) sum += m_fem.contacts(body).size();
        return sum;
    }

    ConcaveShape m_ground;
    FemWorld m_world;
    btFemSoftBodySolver& m_fem = m_world.fem();
    std::vector<btSoftBody*> m_soft;
    std::vector<btRigidBody*> m_rigid;
};

}  // namespace bullet_fem

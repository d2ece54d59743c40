// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "demos/browser/scene.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "bullet_fem/btFemHelpers.h"
#include "bullet_fem/btFemRay.h"
#include "bullet_fem/fem/baked/baked_body.h"
#include "demos/common/demo_measures.h"
#include "demos/common/demo_world.h"

namespace
{
using namespace bullet_fem;

constexpr double kDrop = 0.02;                    // initial gap under the body's feet [m]
constexpr double kFriction = 0.8;                 // of all bodies
constexpr double kRollingFriction = 0.02;         // of ball and box [m]
constexpr btScalar kBallRadius = btScalar(0.13);  // [m]
constexpr double kSpringStiffness = 6000;         // of the mouse [N/m]
constexpr double kSpringDamping = 200;            // [N s/m]
constexpr double kSpringWeights = 20;             // maximum force of the mouse, in weights of the body

constexpr double kFeet = 0.12;  // height of the feet, in heights of the body

struct Settings
{
    double m_young = 316228, m_damping = 0.01, m_gravity = kGravity, m_step = kDemoStep;
};

struct Scene
{
    DemoWorld m_world;
    btSoftBody* m_body = nullptr;
    std::vector<btRigidBody*> m_rigid;  // without the ground
    std::vector<int> m_feet;            // nodes
    int m_spring = 0;                   // handle of the spring; 0: nothing is held
    btFemSpring m_held;
};

std::optional<BakedBody> baked;
Settings settings;
std::unique_ptr<Scene> scene;
std::string error;
float three[3], pose[16];
std::vector<float> vertices;
std::vector<int> triangles;

const float* give(const btVector3& v)
{
    for (int c = 0; c < 3; ++c) three[c] = float(v[c]);
    return three;
}

btFemMaterial material()
{
    const Material& asBaked = baked->m_model->shape().m_material;
    btFemMaterial m;
    m.m_youngModulus = btScalar(settings.m_young);
    m.m_poissonRatio = btScalar(asBaked.m_poissonRatio);
    m.m_density = btScalar(asBaked.m_density);
    m.m_stiffnessDamping = btScalar(settings.m_damping);
    return m;
}

void addRigid(btCollisionShape* shape, double mass, const btVector3& place)
{
    btRigidBody& body = scene->m_world.addRigid(shape, mass, place, kFriction);
    body.setRollingFriction(btScalar(kRollingFriction));
    scene->m_rigid.push_back(&body);
}

/// Sets the gravity of the world and of the soft body, and wakes all bodies.
void setGravity()
{
    btSoftRigidDynamicsWorld& world = scene->m_world.bullet();
    world.setGravity(at(0, -settings.m_gravity, 0));
    world.getWorldInfo().m_gravity = world.getGravity();
    scene->m_body->activate(true);
    for (btRigidBody* body : scene->m_rigid) body->activate(true);
}

void start()
{
    scene = std::make_unique<Scene>();
    DemoWorld& world = scene->m_world;
    world.addGround(kFriction);
    btSoftBody* body = btFemHelpers::createFromBaked(world.info(), *baked);
    body->translate(at(0, kDrop - double(lowestOf(*body).y()), 0));
    btFemHelpers::updateEmbeddedSurface(body);
    const double low = double(lowestOf(*body).y()), height = double(sizeOf(*body).y());
    for (int i = 0; i < body->m_nodes.size(); ++i)
        if (double(body->m_nodes[i].m_x.y()) < low + kFeet * height) scene->m_feet.push_back(i);
    world.fem().useBaked(body, *baked);
    scene->m_body = &world.addSoft(body, material(), kFriction, settings.m_step);
    addRigid(new btSphereShape(kBallRadius), 4, at(0.2, 1.6, -0.1));
    addRigid(new btBoxShape(at(0.15, 0.15, 0.15)), 8, at(0.8, 0.16, 0.2));
    setGravity();
}

/// Stores the message of an exception in `error`; JavaScript then gets 0.
template <class Function>
int attempt(Function&& function)
{
    try
    {
        function();
        return 1;
    }
    catch (const std::exception& e)
    {
        error = e.what();
        return 0;
    }
}

void checkRange(const char* name, double value, double low, double high)
{
    if (!(value >= low && value <= high))
        throw std::invalid_argument(std::string(name) + " is " + std::to_string(value) + ", must be in [" +
                                    std::to_string(low) + ", " + std::to_string(high) + "]");
}

}  // namespace

extern "C"
{
    int scene_open(const unsigned char* bytes, int count)
    {
        return attempt(
            [&]
            {
                if (bytes) baked = readBakedBody(bytes, std::size_t(count), "the body");
                if (!baked) throw std::invalid_argument("there is no body yet: give the bytes of a .bfem file");
                start();
            });
    }

    const char* scene_error()
    {
        return error.c_str();
    }

    int scene_set(double young, double damping, double gravity, double step)
    {
        return attempt(
            [&]
            {
                checkRange("Young's modulus", young, 1e3, 1e9);
                checkRange("damping", damping, 0, 1);
                checkRange("gravity", gravity, 0, 100);
                checkRange("the step", step, 1e-3, 0.05);
                const Settings before = settings;
                settings = {young, damping, gravity, step};
                if (!scene) return;
                if (gravity != before.m_gravity) setGravity();
                if (young != before.m_young || damping != before.m_damping)
                    scene->m_world.fem().setMaterial(scene->m_body, material());
                if (step != before.m_step) scene->m_world.fem().prepare(scene->m_body, btScalar(step));
                scene->m_body->activate(true);
            });
    }

    int scene_hold_feet(int held)
    {
        return attempt(
            [&]
            {
                btSoftBody* body = scene->m_body;
                btFemSoftBodySolver& fem = scene->m_world.fem();
                for (const int node : scene->m_feet)
                    if (held)
                        fem.setNodeTarget(body, node, body->m_nodes[node].m_x);
                    else
                        fem.clearNodeTarget(body, node);
                fem.prepare(body, btScalar(settings.m_step));
                body->activate(true);
            });
    }

    void scene_step()
    {
        scene->m_world.bullet().stepSimulation(btScalar(settings.m_step), 0);
    }

    int scene_pick(double x0, double y0, double z0, double x1, double y1, double z1)
    {
        scene_release();
        const btVector3 from = at(x0, y0, z0), to = at(x1, y1, z1);
        btFemClosestRay ray(from, to);
        scene->m_world.bullet().rayTest(from, to, ray);
        if (!ray.hasHit() || ray.m_collisionObject != scene->m_body) return 0;
        btFemSpring& spring = scene->m_held;
        spring = btFemSpring::at(ray.m_hit);
        spring.m_stiffness = btScalar(kSpringStiffness);
        spring.m_damping = btScalar(kSpringDamping);
        spring.m_maxForce = btScalar(kSpringWeights * massOf(*scene->m_body) * kGravity);
        scene->m_spring = scene->m_world.fem().addSpring(scene->m_body, spring);
        return 1;
    }

    int scene_drag(double x, double y, double z)
    {
        if (scene->m_spring == 0) return 0;
        return attempt([&] { scene->m_world.fem().setSpringTarget(scene->m_body, scene->m_spring, at(x, y, z)); });
    }

    void scene_release()
    {
        if (scene->m_spring != 0) scene->m_world.fem().removeSpring(scene->m_body, scene->m_spring);
        scene->m_spring = 0;
    }

    const float* scene_held()
    {
        if (scene->m_spring == 0) return nullptr;
        btVector3 point(0, 0, 0);
        for (int a = 0; a < 3; ++a)
            point += scene->m_held.m_weights[a] * scene->m_body->m_nodes[scene->m_held.m_nodes[a]].m_x;
        return give(point);
    }

    int scene_vertex_count()
    {
        return scene->m_body->m_renderNodes.size();
    }

    const float* scene_vertices()
    {
        const btSoftBody& body = *scene->m_body;
        std::vector<btVector3> normals(std::size_t(body.m_renderNodes.size()), btVector3(0, 0, 0));
        for (int t = 0; t < body.m_renderFaces.size(); ++t)
        {
            const auto& n = body.m_renderFaces[t].m_n;
            const btVector3 area = (n[1]->m_x - n[0]->m_x).cross(n[2]->m_x - n[0]->m_x);
            for (const btSoftBody::RenderNode* node : n) normals[std::size_t(node - &body.m_renderNodes[0])] += area;
        }
        vertices.clear();
        for (std::size_t v = 0; v < normals.size(); ++v)
        {
            const btVector3 normal = normals[v].fuzzyZero() ? at(0, 1, 0) : normals[v].normalized();
            for (const btVector3& each : {body.m_renderNodes[int(v)].m_x, normal})
                for (int c = 0; c < 3; ++c) vertices.push_back(float(each[c]));
        }
        return vertices.data();
    }

    int scene_triangle_count()
    {
        return scene->m_body->m_renderFaces.size();
    }

    const int* scene_triangles()
    {
        const btSoftBody& body = *scene->m_body;
        triangles.clear();
        for (int t = 0; t < body.m_renderFaces.size(); ++t)
            for (const btSoftBody::RenderNode* node : body.m_renderFaces[t].m_n)
                triangles.push_back(int(node - &body.m_renderNodes[0]));
        return triangles.data();
    }

    int scene_rigid_count()
    {
        return int(scene->m_rigid.size());
    }

    int scene_rigid_is_ball(int body)
    {
        return scene->m_rigid[std::size_t(body)]->getCollisionShape()->getShapeType() == SPHERE_SHAPE_PROXYTYPE;
    }

    const float* scene_rigid_pose(int body)
    {
        const btRigidBody& rigid = *scene->m_rigid[std::size_t(body)];
        btVector3 low, half;
        rigid.getCollisionShape()->getAabb(btTransform::getIdentity(), low, half);
        const btTransform& place = rigid.getWorldTransform();
        for (int column = 0; column < 3; ++column)
            for (int row = 0; row < 4; ++row)
                pose[4 * column + row] = row < 3 ? float(place.getBasis()[row][column] * half[column]) : 0;
        for (int row = 0; row < 4; ++row) pose[12 + row] = row < 3 ? float(place.getOrigin()[row]) : 1;
        return pose;
    }

    int scene_tets()
    {
        return scene->m_body->m_tetras.size();
    }
    int scene_iterations()
    {
        return scene->m_world.fem().stepReport(scene->m_body).m_iterations;
    }
    int scene_contacts()
    {
        return scene->m_world.fem().stepReport(scene->m_body).m_contacts;
    }
    int scene_asleep()
    {
        return !scene->m_body->isActive();
    }
    double scene_mass()
    {
        return massOf(*scene->m_body);
    }

    double scene_fastest()
    {
        double fastest = 0;
        for (int i = 0; i < scene->m_body->m_nodes.size(); ++i)
            fastest = std::max(fastest, double(scene->m_body->m_nodes[i].m_v.length()));
        return fastest;
    }

    const float* scene_centre()
    {
        return give(centreOf(*scene->m_body));
    }
}

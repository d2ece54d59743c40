// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "tools/scene/scene_world.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

#include "BulletSoftBody/btSoftBody.h"
#include "LinearMath/btTransformUtil.h"
#include "bullet_fem/btFemHelpers.h"
#include "bullet_fem/btFemVectors.h"
#include "bullet_fem/fem/baked/baked_body.h"
#include "bullet_fem/fem/mesh/generators.h"
#include "bullet_fem/io/surface_file.h"
#include "bullet_fem/io/tet_mesh_file.h"
#include "tools/scene/scene_shapes.h"

namespace bullet_fem
{
namespace
{

btFemSolverInfo solverInfo(const SceneDescription& scene)
{
    btFemSolverInfo info;
    info.m_tolerance = btScalar(scene.m_tolerance);
    info.m_contactTolerance = btScalar(scene.m_contactTolerance);
    info.m_threads = scene.m_threads;
    return info;
}

std::unique_ptr<btConstraintSolver> rigidSolver(bool coupled, btFemSoftBodySolver& fem)
{
    if (coupled) return std::make_unique<btFemConstraintSolver>(&fem);
    return std::make_unique<btSequentialImpulseConstraintSolver>();
}

btTransform transformOf(const ScenePose& pose)
{
    return btTransform(btQuaternion(bulletVector(pose.m_axis), btScalar(pose.m_angle)), bulletVector(pose.m_position));
}

constexpr double kMostCells = 1e6;  // along an edge; more than makeBox takes, which then says so

double cellsAlong(double edge, double cell)
{
    return std::clamp(std::round(edge / cell), 1.0, kMostCells);
}

// The cell [m] that gives a block about `tets` elements, five a cell. By bisection: thin blocks have one cell across
// however large it is.
double cellFor(const Vec3& size, double tets)
{
    const auto count = [&](double cell)
    { return 5 * cellsAlong(size.x, cell) * cellsAlong(size.y, cell) * cellsAlong(size.z, cell); };
    double low = 1e-12 * (size.x + size.y + size.z), high = 2 * (size.x + size.y + size.z);
    for (int k = 0; k < 100; ++k)
    {
        const double middle = std::sqrt(low * high);
        (count(middle) < tets ? high : low) = middle;
    }
    return tets * tets < count(low) * count(high) ? high : low;  // the nearer one, as a ratio
}

TetMesh blockOf(const SceneMesh& mesh)
{
    const Vec3 size = mesh.m_scale * mesh.m_size;
    const double cell = mesh.m_cellSize > 0 ? mesh.m_cellSize : cellFor(size, mesh.m_tets);
    std::array<int, 3> cells;
    for (int i = 0; i < 3; ++i) cells[i] = static_cast<int>(cellsAlong(size[i], cell));
    return makeBox(size, cells, -0.5 * size);
}

CageSettings cageOf(const SceneMesh& mesh)
{
    CageSettings settings;
    settings.m_cellSize = mesh.m_cellSize;
    settings.m_targetTets = mesh.m_cellSize > 0 ? 0 : mesh.m_tets;
    settings.m_cellsAcross = mesh.m_cellsAcross;
    settings.m_mostLevels = mesh.m_mostLevels;
    settings.m_maxTets = 5000000;
    settings.m_surfaceCollides = mesh.m_surfaceCollides;
    return settings;
}

std::vector<int> nodesIn(const btSoftBody& body, const SceneBox& box)
{
    std::vector<int> nodes;
    for (int i = 0; i < body.m_nodes.size(); ++i)
        if (box.contains(vec3(body.m_nodes[i].m_x))) nodes.push_back(i);
    return nodes;
}

// Calls what makes a body; what goes wrong then names it.
template <class Make>
void named(const std::string& name, const Make& make)
{
    try
    {
        make();
    }
    catch (const std::exception& error)
    {
        throw std::runtime_error("'" + name + "': " + error.what());
    }
}

}  // namespace

btFemMaterial materialOf(const Material& material)
{
    btFemMaterial result;
    result.m_youngModulus = btScalar(material.m_youngModulus);
    result.m_poissonRatio = btScalar(material.m_poissonRatio);
    result.m_density = btScalar(material.m_density);
    result.m_massDamping = btScalar(material.m_massDamping);
    result.m_stiffnessDamping = btScalar(material.m_stiffnessDamping);
    return result;
}

SceneWorld::SceneWorld(const SceneDescription& description)
    : m_description(description),
      m_fem(solverInfo(description)),
      m_rigidSolver(rigidSolver(description.m_coupled, m_fem)),
      m_world(&m_dispatcher, &m_broadphase, m_rigidSolver.get(), &m_configuration, &m_fem)
{
    m_configuration.setPlaneConvexMultipointIterations();  // else boxes touch a plane in one point, and sink into it
    m_world.setGravity(bulletVector(description.m_gravity));
    m_world.getWorldInfo().m_gravity = bulletVector(description.m_gravity);
    for (const SceneRigidBody& body : description.m_rigidBodies) addRigid(body);
    for (const SceneSoftBody& body : description.m_softBodies) named(body.m_name, [&] { addSoft(body); });
    for (const SceneConstraint& constraint : description.m_constraints) addConstraint(constraint);
    for (const SceneForce& force : description.m_forces) addForce(force);
    for (int i = 0; i < softCount(); ++i)
        named(description.m_softBodies[i].m_name, [&] { m_fem.prepare(&soft(i), btScalar(description.m_step)); });
}

SceneWorld::~SceneWorld()
{
    for (const auto& joint : m_joints) m_world.removeConstraint(joint.get());
    for (const auto& body : m_softBodies) m_world.removeSoftBody(body.get());
    for (const auto& body : m_rigidBodies) m_world.removeRigidBody(body.get());
}

void SceneWorld::step()
{
    applyForces();
    moveKinematic();
    m_world.stepSimulation(btScalar(m_description.m_step), 0);  // 0: one step of just this size
    ++m_steps;
}

// Bullet takes a kinematic body's velocity from where it is put.
void SceneWorld::moveKinematic()
{
    for (int i = 0; i < rigidCount(); ++i)
    {
        btRigidBody& body = *m_rigidBodies[i];
        if (!body.isKinematicObject()) continue;
        const SceneRigidBody& from = m_description.m_rigidBodies[i];
        btTransform next;
        btTransformUtil::integrateTransform(body.getWorldTransform(), bulletVector(from.m_velocity),
                                            bulletVector(from.m_spin), btScalar(m_description.m_step), next);
        body.setWorldTransform(next);
    }
}

std::unique_ptr<btSoftBody> SceneWorld::makeSoft(const SceneSoftBody& from)
{
    btSoftBodyWorldInfo& info = m_world.getWorldInfo();
    const SceneMesh& mesh = from.m_mesh;
    switch (mesh.m_kind)
    {
        case SceneMesh::Kind::box:
            return std::unique_ptr<btSoftBody>(btFemHelpers::createFromTetMesh(info, blockOf(mesh)));
        case SceneMesh::Kind::surface:
            return std::unique_ptr<btSoftBody>(
                btFemHelpers::createFromSurface(info, readSurfaceFile(mesh.m_path, mesh.m_scale), cageOf(mesh)));
        case SceneMesh::Kind::tetrahedra:
            return std::unique_ptr<btSoftBody>(
                btFemHelpers::createFromTetMesh(info, readTetMeshFile(mesh.m_path, mesh.m_scale).mesh()));
        default:
            break;
    }
    const BakedBody baked = readBakedBody(mesh.m_path);
    std::unique_ptr<btSoftBody> body(btFemHelpers::createFromBaked(info, baked));
    m_fem.useBaked(body.get(), baked);
    return body;
}

void SceneWorld::addSoft(const SceneSoftBody& from)
{
    std::unique_ptr<btSoftBody> body = makeSoft(from);
    if (from.m_mesh.m_kind != SceneMesh::Kind::baked) m_fem.setMaterial(body.get(), materialOf(from.m_material));
    body->transform(transformOf(from.m_pose));
    body->m_cfg.kDF = btScalar(from.m_friction);
    if (from.m_selfContact) body->m_cfg.collisions |= btSoftBody::fCollision::CL_SELF;
    for (const SceneBox& box : from.m_pins)
    {
        const std::vector<int> nodes = nodesIn(*body, box);
        if (nodes.empty()) throw std::runtime_error("a box of its pins holds no node at the start; move or enlarge it");
        for (const int node : nodes) body->setMass(node, 0);
    }
    body->setVelocity(bulletVector(from.m_velocity));
    m_world.addSoftBody(body.get());
    m_softBodies.push_back(std::move(body));
}

void SceneWorld::addRigid(const SceneRigidBody& from)
{
    m_shapes.push_back(makeShape(from.m_shape));
    btVector3 inertia(0, 0, 0);
    if (from.m_mass > 0) m_shapes.back()->calculateLocalInertia(btScalar(from.m_mass), inertia);
    btRigidBody::btRigidBodyConstructionInfo info(btScalar(from.m_mass), nullptr, m_shapes.back().get(), inertia);
    info.m_startWorldTransform = transformOf(from.m_pose);
    info.m_friction = btScalar(from.m_friction);
    info.m_restitution = btScalar(from.m_restitution);
    m_rigidBodies.push_back(std::make_unique<btRigidBody>(info));
    btRigidBody& body = *m_rigidBodies.back();
    const bool moves = norm(from.m_velocity) > 0 || norm(from.m_spin) > 0;
    if (from.m_mass == 0 && moves)
    {
        body.setCollisionFlags(body.getCollisionFlags() | btCollisionObject::CF_KINEMATIC_OBJECT);
        body.setActivationState(DISABLE_DEACTIVATION);
    }
    m_world.addRigidBody(&body);
    body.setLinearVelocity(bulletVector(from.m_velocity));
    body.setAngularVelocity(bulletVector(from.m_spin));
}

btRigidBody& SceneWorld::rigidCalled(const std::string& name)
{
    for (int i = 0; i < rigidCount(); ++i)
        if (m_description.m_rigidBodies[i].m_name == name) return *m_rigidBodies[i];
    throw std::runtime_error("there is no rigid body '" + name + "'");
}

btSoftBody& SceneWorld::softCalled(const std::string& name)
{
    for (int i = 0; i < softCount(); ++i)
        if (m_description.m_softBodies[i].m_name == name) return *m_softBodies[i];
    throw std::runtime_error("there is no soft body '" + name + "'");
}

void SceneWorld::addAnchors(const SceneConstraint& from)
{
    btSoftBody& soft = softCalled(from.m_a);
    btRigidBody& rigid = rigidCalled(from.m_b);
    const std::vector<int> nodes = nodesIn(soft, from.m_box);
    if (nodes.empty())
        throw std::runtime_error("'" + from.m_a + "': the box of its anchors to '" + from.m_b +
                                 "' holds no node at the start; move or enlarge it");
    for (const int node : nodes) soft.appendAnchor(node, &rigid, true);
}

void SceneWorld::addConstraint(const SceneConstraint& from)
{
    if (from.m_kind == SceneConstraint::Kind::anchor) return addAnchors(from);
    btRigidBody& a = rigidCalled(from.m_a);
    btRigidBody& b = from.m_b.empty() ? btTypedConstraint::getFixedBody() : rigidCalled(from.m_b);
    const btTransform intoA = a.getWorldTransform().inverse(), intoB = b.getWorldTransform().inverse();
    const btVector3 pivot = bulletVector(from.m_pivot), axis = bulletVector(from.m_axis).normalized();
    if (from.m_kind == SceneConstraint::Kind::point)
        m_joints.push_back(std::make_unique<btPoint2PointConstraint>(a, b, intoA * pivot, intoB * pivot));
    else
    {
        btVector3 axisInA = intoA.getBasis() * axis, axisInB = intoB.getBasis() * axis;
        auto hinge = std::make_unique<btHingeConstraint>(a, b, intoA * pivot, intoB * pivot, axisInA, axisInB);
        if (from.m_torque > 0)
            hinge->enableAngularMotor(true, btScalar(from.m_speed),
                                      btScalar(from.m_torque * m_description.m_step));  // an impulse
        m_joints.push_back(std::move(hinge));
    }
    m_world.addConstraint(m_joints.back().get(), true);
}

void SceneWorld::addForce(const SceneForce& from)
{
    m_forces.emplace_back();
    ForceNodes& target = m_forces.back();
    for (int i = 0; i < rigidCount(); ++i)
        if (m_description.m_rigidBodies[i].m_name == from.m_body) target.m_rigid = m_rigidBodies[i].get();
    if (target.m_rigid) return;
    target.m_soft = &softCalled(from.m_body);
    double sum = 0;
    for (int i = 0; i < target.m_soft->m_nodes.size(); ++i)
    {
        const btSoftBody::Node& node = target.m_soft->m_nodes[i];
        if (node.m_im <= 0 || !(from.m_everywhere || from.m_box.contains(vec3(node.m_x)))) continue;
        target.m_nodes.push_back(i);
        target.m_shares.push_back(from.m_everywhere ? 1 / double(node.m_im) : 1.0);
        sum += target.m_shares.back();
    }
    if (target.m_nodes.empty())
        throw std::runtime_error("'" + from.m_body +
                                 "': the box of a force holds no free node at the start; move or enlarge it");
    for (double& share : target.m_shares) share /= sum;
}

void SceneWorld::applyForces()
{
    const double now = time() + 1e-6 * m_description.m_step;  // steps that begin at a force's end are after it
    for (std::size_t f = 0; f < m_forces.size(); ++f)
    {
        const SceneForce& force = m_description.m_forces[f];
        const ForceNodes& target = m_forces[f];
        if (now < force.m_from || now >= force.m_to) continue;
        if (target.m_rigid)
        {
            target.m_rigid->activate();
            target.m_rigid->applyCentralForce(bulletVector(force.m_force));
            continue;
        }
        target.m_soft->activate();
        for (std::size_t i = 0; i < target.m_nodes.size(); ++i)
            target.m_soft->addForce(bulletVector(target.m_shares[i] * force.m_force), target.m_nodes[i]);
    }
}

}  // namespace bullet_fem

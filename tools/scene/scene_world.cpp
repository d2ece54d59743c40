// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "tools/scene/scene_world.h"

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "BulletSoftBody/btSoftBody.h"
#include "LinearMath/btTransformUtil.h"
#include "bullet_fem/btFemHelpers.h"
#include "bullet_fem/btFemVectors.h"
#include "bullet_fem/fem/baked/baked_body.h"
#include "bullet_fem/io/surface_file.h"
#include "bullet_fem/io/tet_mesh_file.h"
#include "fem/common/reason.h"
#include "tools/scene/scene_meshes.h"
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

std::vector<int> nodesIn(const btSoftBody& body, const SceneBox& box)
{
    std::vector<int> nodes;
    for (int i = 0; i < body.m_nodes.size(); ++i)
        if (box.contains(vec3(body.m_nodes[i].m_x))) nodes.push_back(i);
    return nodes;
}

// Sets the initial pose and all properties other than the material.
void place(btSoftBody& body, const SceneSoftBody& from)
{
    body.transform(transformOf(from.m_pose));
    body.m_cfg.kDF = btScalar(from.m_friction);
    body.setRestitution(btScalar(from.m_restitution));
    if (from.m_selfContact) body.m_cfg.collisions |= btSoftBody::fCollision::CL_SELF;
    for (const SceneBox& box : from.m_pins)
    {
        const std::vector<int> nodes = nodesIn(body, box);
        if (nodes.empty()) throw std::runtime_error("a box of its pins holds no node at the start; move or enlarge it");
        for (const int node : nodes) body.setMass(node, 0);
    }
    body.setVelocity(bulletVector(from.m_velocity));
}

bool moves(const SceneVectorCurve& velocity)
{
    return std::any_of(velocity.m_points.begin(), velocity.m_points.end(),
                       [](const SceneVectorCurve::Point& point) { return norm(point.m_value) > 0; });
}

// Calls `make` and adds the body's name to exceptions.
template <class Make>
void named(const std::string& name, const Make& make)
{
    try
    {
        make();
    }
    catch (const std::exception& error)
    {
        throw std::runtime_error("'" + name + "': " + reasonOf(error));
    }
}

}  // namespace

SceneWorld::SceneWorld(const SceneDescription& description)
    : m_description(description),
      m_fem(solverInfo(description)),
      m_rigidSolver(rigidSolver(description.m_coupled, m_fem)),
      m_world(&m_dispatcher, &m_broadphase, m_rigidSolver.get(), &m_configuration, &m_fem)
{
    m_configuration.setPlaneConvexMultipointIterations();  // otherwise boxes get one contact point and penetrate
    m_world.setGravity(bulletVector(description.m_gravity));
    m_world.getWorldInfo().m_gravity = bulletVector(description.m_gravity);
    for (const SceneRigidBody& body : m_description.m_rigidBodies) addRigid(body);
    addSoftBodies(std::exchange(m_description.m_softBodies, {}));
    for (const SceneConstraint& constraint : m_description.m_constraints) addConstraint(constraint);
    for (const SceneForce& force : m_description.m_forces) addForce(force);
    for (int i = 0; i < softCount(); ++i)
        named(m_description.m_softBodies[i].m_name, [&] { m_fem.prepare(&soft(i), btScalar(description.m_step)); });
    weldBodies();
    for (int i = 0; i < softCount(); ++i)
        named(m_description.m_softBodies[i].m_name,
              [&] { m_fractures.add(m_fem, soft(i), m_description.m_softBodies[i].m_fracture); });
    for (const SceneSpring& spring : m_description.m_springs) m_springs.add(softCalled(spring.m_body), spring);
    for (const SceneActuator& actuator : m_description.m_actuators)
        named(actuator.m_body, [&] { m_actuators.add(m_fem, *softCalled(actuator.m_body).front(), actuator); });
    for (const SceneSensor& sensor : m_description.m_sensors)
        m_sensors.add(sensor, softCalled(sensor.m_body), sensor.m_to.empty() ? nullptr : &rigidCalled(sensor.m_to));
}

SceneWorld::~SceneWorld()
{
    m_joints.removeFrom(m_world);
    for (const auto& body : m_softBodies) m_world.removeSoftBody(body.get());
    for (const auto& body : m_rigidBodies) m_world.removeRigidBody(body.get());
}

void SceneWorld::add(const SceneRigidBody& body)
{
    addRigid(body);
    m_description.m_rigidBodies.push_back(body);
}

void SceneWorld::add(const SceneSoftBody& body, const BakedBody& baked)
{
    SceneSoftBody added = body;
    added.m_mesh.m_kind = SceneMesh::Kind::baked;
    const std::size_t count = m_softBodies.size();
    m_materials.emplace_back();
    m_regionLabels.emplace_back();
    try
    {
        named(added.m_name, [&] { addSoft(added, makeBaked(baked)); });
    }
    catch (...)  // undoes the addition
    {
        m_materials.resize(count);
        m_regionLabels.resize(count);
        throw;
    }
    m_description.m_softBodies.push_back(added);
    m_fem.prepare(m_softBodies.back().get(), btScalar(m_description.m_step));
}

void SceneWorld::setGravity(const Vec3& gravity)
{
    m_description.m_gravity = gravity;
    m_world.setGravity(bulletVector(gravity));  // also sets that of rigid bodies
    m_world.getWorldInfo().m_gravity = bulletVector(gravity);
    for (const auto& body : m_softBodies) body->activate();
    for (const auto& body : m_rigidBodies) body->activate();
}

void SceneWorld::setSteps(long steps)
{
    m_steps = steps;
    m_actuators.begin((double(steps) - 1) * m_description.m_step);
}

void SceneWorld::step()
{
    m_forces.apply(time(), m_description.m_step);
    m_actuators.apply(m_fem, time());
    m_springs.apply(m_fem, time() + 1e-6 * m_description.m_step);  // a step that begins at a spring's end is excluded
    m_joints.apply(time() + m_description.m_step / 2);
    moveKinematic(time() + m_description.m_step / 2);
    m_world.stepSimulation(btScalar(m_description.m_step), 0);  // 0: one step of exactly this size
    m_fractures.update(m_fem, m_forces);
    ++m_steps;
}

// Bullet derives a kinematic body's velocity from its change of pose.
void SceneWorld::moveKinematic(double middle)
{
    for (int i = 0; i < rigidCount(); ++i)
    {
        btRigidBody& body = *m_rigidBodies[i];
        if (!body.isKinematicObject()) continue;
        const SceneRigidBody& from = m_description.m_rigidBodies[i];
        btTransform next;
        btTransformUtil::integrateTransform(body.getWorldTransform(), bulletVector(from.m_velocity.at(middle)),
                                            bulletVector(from.m_spin.at(middle)), btScalar(m_description.m_step), next);
        body.setWorldTransform(next);
    }
}

std::unique_ptr<btSoftBody> SceneWorld::makeSoft(const SceneSoftBody& from)
{
    btSoftBodyWorldInfo& info = m_world.getWorldInfo();
    const SceneMesh& mesh = from.m_mesh;
    m_materials.emplace_back();
    m_regionLabels.emplace_back();
    switch (mesh.m_kind)
    {
        case SceneMesh::Kind::box:
            return std::unique_ptr<btSoftBody>(btFemHelpers::createFromTetMesh(info, blockOf(mesh)));
        case SceneMesh::Kind::sphere:
            return std::unique_ptr<btSoftBody>(btFemHelpers::createFromTetMesh(info, ballOf(mesh)));
        case SceneMesh::Kind::cylinder:
            return std::unique_ptr<btSoftBody>(btFemHelpers::createFromTetMesh(info, cylinderOf(mesh)));
        case SceneMesh::Kind::surface:
        {
            CageReport report;
            std::unique_ptr<btSoftBody> body(btFemHelpers::createFromSurface(
                info, readSurfaceFile(mesh.m_path, mesh.m_scale), cageOf(mesh), report));
            if (!from.m_regionMaterials.empty()) m_regionLabels.back() = std::move(report.m_regions);
            return body;
        }
        case SceneMesh::Kind::tetrahedra:
        {
            TetMeshFile file = readTetMeshFile(mesh.m_path, mesh.m_scale);
            m_regionLabels.back() = std::move(file.m_regions);
            return std::unique_ptr<btSoftBody>(btFemHelpers::createFromTetMesh(info, file.mesh()));
        }
        default:
            return makeBaked(readBakedBody(mesh.m_path));
    }
}

std::unique_ptr<btSoftBody> SceneWorld::makeBaked(const BakedBody& baked)
{
    std::unique_ptr<btSoftBody> body(btFemHelpers::createFromBaked(m_world.getWorldInfo(), baked));
    m_fem.useBaked(body.get(), baked);
    const ElementMaterials& materials = m_materials.back() = baked.m_model->shape().m_materials;
    for (const int region : materials.m_regionOf) m_regionLabels.back().push_back(materials.m_regions[region].m_label);
    return body;
}

void SceneWorld::giveMaterials(btSoftBody& body, const SceneSoftBody& from)
{
    const btMatrix3x3 turn = transformOf(from.m_pose).getBasis();
    if (from.m_regionMaterials.empty())
    {
        const Material material = turned(from.m_material, turn);
        m_materials.back() = material;
        m_fem.setMaterial(&body, materialOf(material));
        return;
    }
    std::map<int, Material> ofRegion;
    for (const auto& [label, material] : from.m_regionMaterials) ofRegion[label] = turned(material, turn);
    const std::vector<int>& labels = m_regionLabels.back();
    if (labels.empty()) throw std::runtime_error("its file has no regions and is not painted; give it one material");
    m_materials.back() = ElementMaterials::ofLabels(labels, ofRegion);
    std::map<int, btFemMaterial> materials;
    for (const auto& [label, material] : ofRegion) materials[label] = materialOf(material);
    m_fem.setMaterials(&body, labels, materials);
}

void SceneWorld::addSoftBodies(const std::vector<SceneSoftBody>& bodies)
{
    for (const SceneSoftBody& body : bodies)
        named(body.m_name,
              [&]
              {
                  if (body.m_pieces.m_cells > 0) return addPieces(body);
                  addSoft(body, makeSoft(body));
                  m_description.m_softBodies.push_back(body);
              });
}

void SceneWorld::addPieces(const SceneSoftBody& from)
{
    const std::unique_ptr<btSoftBody> whole = makeSoft(from);
    const std::vector<int> labels = std::move(m_regionLabels.back());
    m_materials.pop_back();
    m_regionLabels.pop_back();
    place(*whole, from);
    CutSceneBody cut = cutBody(*whole, from.m_pieces);
    for (std::size_t k = 0; k < cut.m_bodies.size(); ++k)
    {
        m_materials.emplace_back();
        m_regionLabels.emplace_back();
        for (const int e : cut.m_pieces[k].m_tets)
            if (!labels.empty()) m_regionLabels.back().push_back(labels[e]);
        giveMaterials(*cut.m_bodies[k], from);
        m_world.addSoftBody(cut.m_bodies[k].get());
        m_softBodies.push_back(std::move(cut.m_bodies[k]));
        m_description.m_softBodies.push_back(from);
        m_description.m_softBodies.back().m_whole = from.m_name;
        m_description.m_softBodies.back().m_name += "." + std::to_string(k);
    }
    m_cutBodies.push_back({from.m_name, std::move(cut.m_pieces), from.m_pieces.m_strength});
}

void SceneWorld::weldBodies()
{
    for (const CutBody& body : m_cutBodies)
        named(body.m_name, [&] { weldPieces(m_fem, body.m_pieces, body.m_strength); });
    for (const SceneWeld& weld : m_description.m_welds)
        addWeld(m_fem, softCalled(weld.m_a), softCalled(weld.m_b), weld);
}

void SceneWorld::addSoft(const SceneSoftBody& from, std::unique_ptr<btSoftBody> body)
{
    if (from.m_mesh.m_kind != SceneMesh::Kind::baked) giveMaterials(*body, from);
    place(*body, from);
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
    if (from.m_mass == 0 && (moves(from.m_velocity) || moves(from.m_spin)))
    {
        body.setCollisionFlags(body.getCollisionFlags() | btCollisionObject::CF_KINEMATIC_OBJECT);
        body.setActivationState(DISABLE_DEACTIVATION);
    }
    m_world.addRigidBody(&body);
    body.setLinearVelocity(bulletVector(from.m_velocity.at(0)));
    body.setAngularVelocity(bulletVector(from.m_spin.at(0)));
}

btRigidBody& SceneWorld::rigidCalled(const std::string& name)
{
    for (int i = 0; i < rigidCount(); ++i)
        if (m_description.m_rigidBodies[i].m_name == name) return *m_rigidBodies[i];
    throw std::runtime_error("there is no rigid body '" + name + "'");
}

std::vector<btSoftBody*> SceneWorld::softCalled(const std::string& name)
{
    std::vector<btSoftBody*> bodies;
    for (int i = 0; i < softCount(); ++i)
    {
        const SceneSoftBody& body = m_description.m_softBodies[i];
        if ((body.m_whole.empty() ? body.m_name : body.m_whole) == name) bodies.push_back(m_softBodies[i].get());
    }
    if (bodies.empty()) throw std::runtime_error("there is no soft body '" + name + "'");
    return bodies;
}

void SceneWorld::addAnchors(const SceneConstraint& from)
{
    btRigidBody& rigid = rigidCalled(from.m_b);
    bool some = false;
    for (btSoftBody* soft : softCalled(from.m_a))
        for (const int node : nodesIn(*soft, from.m_box))
        {
            soft->appendAnchor(node, &rigid, true);
            some = true;
        }
    if (!some)
        throw std::runtime_error("'" + from.m_a + "': the box of its anchors to '" + from.m_b +
                                 "' holds no node at the start; move or enlarge it");
}

void SceneWorld::addConstraint(const SceneConstraint& from)
{
    if (from.m_kind == SceneConstraint::Kind::anchor) return addAnchors(from);
    btRigidBody& to = from.m_b.empty() ? btTypedConstraint::getFixedBody() : rigidCalled(from.m_b);
    m_joints.add(m_world, from, rigidCalled(from.m_a), to, m_description.m_step);
}

void SceneWorld::addForce(const SceneForce& from)
{
    for (int i = 0; i < rigidCount(); ++i)
        if (m_description.m_rigidBodies[i].m_name == from.m_body) return m_forces.add(from, *m_rigidBodies[i]);
    m_forces.add(from, softCalled(from.m_body));
}

}  // namespace bullet_fem

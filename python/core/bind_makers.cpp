// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "python/core/handles.h"
#include "python/core/soft_maker.h"

namespace bullet_fem::python
{
namespace
{

constexpr double kLargestMass = 1e12;  // [kg]

std::string nameOf(World& world, const py::object& name, const char* kind)
{
    if (name.is_none()) return kind + std::to_string(world.bodies().size());
    if (!py::isinstance<py::str>(name)) throw py::type_error("name must be a string");
    const auto text = name.cast<std::string>();
    for (const BodyEntry& body : world.bodies())
        if (body.m_name == text && (body.m_soft || body.m_rigid))
            throw py::value_error("there is a body '" + text + "' in the world: names must differ");
    return text;
}

void takeMesh(SoftRequest& request, const py::object& mesh, const py::object& material)
{
    if (py::isinstance<BakedBody>(mesh))
    {
        request.m_baked = mesh.cast<const BakedBody*>();
        if (!material.is_none())
            throw py::value_error(
                "material is given, but a baked body has its own: leave it out, or use set_material()");
        return;
    }
    if (!py::isinstance<Mesh>(mesh))
        throw py::type_error("mesh is " + std::string(py::repr(mesh)) + ": it must be a Mesh or a BakedBody");
    request.m_mesh = mesh.cast<const Mesh*>();
    if (py::isinstance<ElementMaterials>(material))
        request.m_materials = material.cast<ElementMaterials>();
    else if (py::isinstance<Material>(material))
        request.m_materials.m_base = material.cast<Material>();
    else if (material.is_none())
        request.m_materials.m_base = withProgramDefaults({});
    else
        throw py::type_error("material is " + std::string(py::repr(material)) +
                             ": it must be a Material or ElementMaterials");
}

SoftHandle addSoftBody(const WorldPointer& world, const py::object& mesh, const py::object& material,
                       py::handle position, py::handle orientation, py::handle velocity, py::handle pins,
                       py::handle friction, py::handle restitution, py::handle contactOffset, bool selfContact,
                       const py::object& name, int group, int mask)
{
    world->guard().changing();
    SoftRequest request;
    takeMesh(request, mesh, material);
    request.m_pose = transformOf(position, orientation);
    request.m_velocity = vectorOf(velocity, "velocity");
    const std::size_t nodes =
        request.m_mesh ? std::size_t(request.m_mesh->m_tets.nodeCount()) : request.m_baked->m_positions.size();
    request.m_pins = indicesOf(pins, "pins", int(nodes));
    request.m_friction = numberOf(friction, "friction", 0, kLargest);
    request.m_restitution = numberOf(restitution, "restitution", 0, 1);
    request.m_contactOffset = numberOf(contactOffset, "contact_offset", 0, 1e3);
    request.m_selfContact = selfContact;
    request.m_name = nameOf(*world, name, "soft");
    request.m_group = group;
    request.m_mask = mask;
    return {{world, addSoft(*world, request)}};
}

std::unique_ptr<btRigidBody> makeRigid(const RigidShape& shape, double mass, const btTransform& pose)
{
    btVector3 inertia(0, 0, 0);
    if (mass > 0) shape.shape()->calculateLocalInertia(btScalar(mass), inertia);
    btRigidBody::btRigidBodyConstructionInfo info(btScalar(mass), nullptr, shape.shape(), inertia);
    info.m_startWorldTransform = pose;
    return std::make_unique<btRigidBody>(info);
}

RigidHandle addRigidBody(const WorldPointer& world, const std::shared_ptr<RigidShape>& shape, py::handle mass,
                         py::handle position, py::handle orientation, py::handle velocity, py::handle angularVelocity,
                         py::handle friction, py::handle restitution, bool kinematic, const py::object& name, int group,
                         int mask)
{
    world->guard().changing();
    const double kilograms = numberOf(mass, "mass", 0, kLargestMass);
    if (kilograms > 0 && (shape->isStaticOnly() || kinematic))
        throw py::value_error("mass is not 0: planes, meshes and kinematic bodies must have mass 0");
    const btVector3 linear = vectorOf(velocity, "velocity"), angular = vectorOf(angularVelocity, "angular_velocity");
    if (kilograms == 0 && !(linear.fuzzyZero() && angular.fuzzyZero()))
        throw py::value_error("velocity is not 0, but mass is: such a body moves only to poses that the program sets");
    auto entry = std::make_unique<RigidEntry>();
    entry->m_shape = shape;
    entry->m_own = makeRigid(*shape, kilograms, transformOf(position, orientation));
    btRigidBody& body = *(entry->m_body = entry->m_own.get());
    body.setFriction(btScalar(numberOf(friction, "friction", 0, kLargest)));
    body.setRestitution(btScalar(numberOf(restitution, "restitution", 0, 1)));
    if (kinematic)
    {
        body.setCollisionFlags(body.getCollisionFlags() | btCollisionObject::CF_KINEMATIC_OBJECT);
        body.setActivationState(DISABLE_DEACTIVATION);
    }
    const int index = world->add(std::move(entry), nameOf(*world, name, "rigid"), group, mask);
    if (kilograms > 0)
    {
        body.setLinearVelocity(linear);
        body.setAngularVelocity(angular);
    }
    return {{world, index}};
}

}  // namespace

void bindMakers(WorldClass& world)
{
    const py::tuple zero = py::make_tuple(0, 0, 0), unturned = py::make_tuple(0, 0, 0, 1);
    world
        .def("add_soft_body", &addSoftBody, py::arg("mesh"), py::arg("material") = py::none(), py::kw_only(),
             py::arg("position") = zero, py::arg("orientation") = unturned, py::arg("velocity") = zero,
             py::arg("pins") = py::make_tuple(), py::arg("friction") = 0.5, py::arg("restitution") = 0,
             py::arg("contact_offset") = 0, py::arg("self_contact") = false, py::arg("name") = py::none(),
             py::arg("group") = 1, py::arg("mask") = -1,
             "Adds a SoftBody: a Mesh or BakedBody at `position` (3,) [m] with `orientation` (x, y, z, w), `velocity` "
             "(3,)\n"
             "[m/s], fixed nodes `pins` (p,), and a distance that it keeps from others, `contact_offset` [m]. Bodies "
             "meet\n"
             "if the group of each, a bit, is in the mask of the other. Factors its matrix, unless it is baked.")
        .def("add_rigid_body", &addRigidBody, py::arg("shape").none(false), py::arg("mass") = 0, py::kw_only(),
             py::arg("position") = zero, py::arg("orientation") = unturned, py::arg("velocity") = zero,
             py::arg("angular_velocity") = zero, py::arg("friction") = 0.5, py::arg("restitution") = 0,
             py::arg("kinematic") = false, py::arg("name") = py::none(), py::arg("group") = 1, py::arg("mask") = -1,
             "Adds a RigidBody of `mass` [kg]; 0 stands still, or moves to the poses that the program sets if it is\n"
             "kinematic. Position (3,) [m], orientation (x, y, z, w), velocity (3,) [m/s], angular velocity (3,) "
             "[rad/s].");
}

}  // namespace bullet_fem::python

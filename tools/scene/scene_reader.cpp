// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "tools/scene/scene_reader.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "fem/common/message.h"
#include "fem/common/reason.h"
#include "tools/scene/json_cursor.h"
#include "tools/scene/json_syntax.h"
#include "tools/scene/scene_actuator_reader.h"
#include "tools/scene/scene_copies.h"
#include "tools/scene/scene_curve_reader.h"
#include "tools/scene/scene_materials.h"
#include "tools/scene/scene_mesh_reader.h"
#include "tools/scene/scene_place_reader.h"
#include "tools/scene/scene_regions.h"
#include "tools/scene/scene_sensor_reader.h"
#include "tools/scene/scene_weld_reader.h"

namespace bullet_fem
{
namespace
{

constexpr double kRadians = 3.14159265358979323846 / 180;
constexpr JsonRange kLength = {0, 1e6, true}, kPlace = {-1e6, 1e6}, kSpeed = {-1e4, 1e4}, kShare = {0, 1},
                    kNotNegative = {0, 1e30}, kAnyForce = {-1e12, 1e12}, kTime = {0, 1e30}, kSpringRange = {0, 1e12};

/// Reads a scene document; its files are relative to one folder.
class SceneReader
{
public:
    explicit SceneReader(std::string folder) { m_scene.m_folder = std::move(folder); }

    SceneDescription read(const JsonCursor& at)
    {
        at.onlyMembers({"$schema", "title", "gravity", "step", "seconds", "framesPerSecond", "solver", "materials",
                        "softBodies", "rigidBodies", "constraints", "welds", "forces", "springs", "actuators",
                        "sensors", "camera", "pictures"});
        std::string schema;  // used by editors only
        at.read("$schema", schema);
        at.read("title", m_scene.m_title);
        at.read("gravity", {-1e4, 1e4}, m_scene.m_gravity);
        at.read("step", {1e-6, 1}, m_scene.m_step);
        at.read("seconds", {0, 1e5, true}, m_scene.m_seconds);
        at.read("framesPerSecond", {0.01, 1e4}, m_scene.m_framesPerSecond);
        if (at.has("solver")) readSolver(at["solver"]);
        if (at.has("materials")) readMaterials(at["materials"]);
        at.forEach("softBodies", [&](const JsonCursor& item) { readSoftBody(item); });
        at.forEach("rigidBodies", [&](const JsonCursor& item) { readRigidBody(item); });
        at.forEach("constraints", [&](const JsonCursor& item) { readConstraint(item); });
        at.forEach("welds", [&](const JsonCursor& item) { addWeld(item); });
        at.forEach("forces", [&](const JsonCursor& item) { readForce(item); });
        at.forEach("springs", [&](const JsonCursor& item) { readSpring(item); });
        at.forEach("actuators", [&](const JsonCursor& item) { addActuator(item); });
        at.forEach("sensors", [&](const JsonCursor& item) { addSensor(item); });
        if (at.has("camera")) readCamera(at["camera"]);
        if (at.has("pictures")) readPictures(at["pictures"]);
        if (m_scene.m_softBodies.empty() && m_scene.m_rigidBodies.empty())
            at.fail("has neither 'softBodies' nor 'rigidBodies'; a scene needs a body");
        return std::move(m_scene);
    }

private:
    void readSolver(const JsonCursor& at)
    {
        at.onlyMembers({"coupled", "tolerance", "contactTolerance", "threads"});
        at.read("coupled", m_scene.m_coupled);
        at.read("tolerance", {1e-8, 0.5}, m_scene.m_tolerance);
        at.read("contactTolerance", {1e-7, 0.1}, m_scene.m_contactTolerance);
        at.read("threads", 1, 64, m_scene.m_threads);
    }

    void readMaterials(const JsonCursor& at)
    {
        std::vector<std::string> names;
        const std::vector<JsonCursor> members = at.members(names);
        for (std::size_t i = 0; i < members.size(); ++i)
            m_materials[names[i]] = readMaterial(members[i], presetMaterials());
    }

    Material material(const JsonCursor& at) const
    {
        return at.isObject() ? readMaterial(at, m_materials) : materialCalled(at, m_materials);
    }

    // Reads a name that must be unique among bodies.
    std::string name(const JsonCursor& at) const
    {
        const std::string name = at["name"].text();
        if (isSoft(name) || isRigid(name)) at["name"].expected("a name that no other body has");
        return name;
    }
    bool isSoft(const std::string& name) const
    {
        return std::any_of(m_scene.m_softBodies.begin(), m_scene.m_softBodies.end(),
                           [&](const SceneSoftBody& body) { return body.m_name == name; });
    }
    bool isRigid(const std::string& name) const
    {
        return std::any_of(m_scene.m_rigidBodies.begin(), m_scene.m_rigidBodies.end(),
                           [&](const SceneRigidBody& body) { return body.m_name == name; });
    }
    std::string softName(const JsonCursor& at) const
    {
        const std::string name = at.text();
        if (!isSoft(name)) at.expected("the name of a soft body");
        return name;
    }
    std::string rigidName(const JsonCursor& at) const
    {
        const std::string name = at.text();
        if (!isRigid(name)) at.expected("the name of a rigid body");
        return name;
    }

    void readSoftBody(const JsonCursor& at)
    {
        at.onlyMembers({"name", "mesh", "position", "rotation", "velocity", "material", "materials", "friction",
                        "restitution", "selfContact", "colour", "pins", "pieces", "fracture", "copies"});
        SceneSoftBody body;
        body.m_name = name(at);
        body.m_material = defaultMaterial();
        body.m_mesh = readMesh(at["mesh"], m_scene.m_folder);
        readPose(at, body.m_pose);
        at.read("velocity", kSpeed, body.m_velocity);
        if (at.has("material") && body.m_mesh.m_kind == SceneMesh::Kind::baked)
            at["material"].fail("is given for a baked body, which has its own; leave it out, or bake it anew");
        if (at.has("material")) body.m_material = material(at["material"]);
        if (at.has("materials") && at.has("material"))
            at["materials"].fail("are given with 'material'; give one of them");
        const bool mayHaveRegions =
            body.m_mesh.m_kind == SceneMesh::Kind::tetrahedra || body.m_mesh.m_kind == SceneMesh::Kind::surface;
        if (at.has("materials") && !mayHaveRegions)
            at["materials"].fail("are given for regions, which only a 'tetrahedra' or 'surface' has; give 'material'");
        if (at.has("materials")) body.m_regionMaterials = readRegionMaterials(at["materials"], m_materials);
        at.read("friction", {0, 10}, body.m_friction);
        at.read("restitution", kShare, body.m_restitution);
        at.read("selfContact", body.m_selfContact);
        at.read("colour", kShare, body.m_colour);
        at.forEach("pins", [&](const JsonCursor& item) { body.m_pins.push_back(readBox(item)); });
        if (at.has("pieces")) body.m_pieces = readPieces(at["pieces"], body.m_mesh.m_kind);
        if (at.has("fracture")) body.m_fracture = readFracture(at["fracture"], body.m_mesh.m_kind);
        addBodies(at, body, m_scene.m_softBodies);
    }

    // Appends the body, or its copies, which are called by its name and a number.
    template <class Body>
    void addBodies(const JsonCursor& at, Body& body, std::vector<Body>& bodies) const
    {
        if (!at.has("copies")) return bodies.push_back(body);
        const std::string name = body.m_name;
        int count = 0;
        for (const ScenePose& pose : readCopies(at["copies"], body.m_pose))
        {
            body.m_name = name + "." + std::to_string(count++);
            if (isSoft(body.m_name) || isRigid(body.m_name))
                at["name"].fail("gives a copy the name '" + body.m_name + "', which another body has");
            body.m_pose = pose;
            bodies.push_back(body);
        }
    }

    static SceneShape shape(const JsonCursor& at)
    {
        at.onlyMembers({"plane", "box", "sphere", "cylinder", "capsule"});
        SceneShape shape;
        const int kinds = at.has("plane") + at.has("box") + at.has("sphere") + at.has("cylinder") + at.has("capsule");
        if (kinds != 1) at.fail("must have one of: plane, box, sphere, cylinder, capsule");
        if (at.has("plane"))
        {
            shape.m_kind = SceneShape::Kind::plane;
            shape.m_size = at["plane"].direction();
        }
        else if (at.has("box"))
            shape.m_size = at["box"].vector(kLength);
        else if (at.has("sphere"))
        {
            shape.m_kind = SceneShape::Kind::sphere;
            shape.m_radius = at["sphere"].number(kLength);
        }
        else
        {
            shape.m_kind = at.has("cylinder") ? SceneShape::Kind::cylinder : SceneShape::Kind::capsule;
            readRound(at[at.has("cylinder") ? "cylinder" : "capsule"], shape.m_radius, shape.m_height);
        }
        return shape;
    }

    void readRigidBody(const JsonCursor& at)
    {
        at.onlyMembers({"name", "shape", "mass", "position", "rotation", "velocity", "spin", "friction", "restitution",
                        "colour", "copies"});
        SceneRigidBody body;
        body.m_name = name(at);
        body.m_shape = shape(at["shape"]);
        at.read("mass", {0, 1e9}, body.m_mass);
        if (body.m_shape.m_kind == SceneShape::Kind::plane && body.m_mass > 0)
            at["mass"].fail("is given for a plane, which stands still; leave it out");
        readPose(at, body.m_pose);
        readMotion(at, "velocity", body, body.m_velocity);
        readMotion(at, "spin", body, body.m_spin);
        at.read("friction", {0, 10}, body.m_friction);
        at.read("restitution", kShare, body.m_restitution);
        at.read("colour", kShare, body.m_colour);
        addBodies(at, body, m_scene.m_rigidBodies);
    }

    static void readMotion(const JsonCursor& at, const char* name, const SceneRigidBody& body, SceneVectorCurve& motion)
    {
        if (!at.has(name)) return;
        if (body.m_mass > 0 && isVectorCurve(at[name]))
            at[name].fail("is given over time for a body with a 'mass', which forces move; give what it starts with");
        motion = readVectorCurve(at[name], kSpeed);
    }

    void readConstraint(const JsonCursor& at)
    {
        SceneConstraint constraint;
        constraint.m_kind =
            static_cast<SceneConstraint::Kind>(at["kind"].choice({"anchor", "point", "hinge", "slider"}));
        if (constraint.m_kind == SceneConstraint::Kind::anchor)
        {
            at.onlyMembers({"kind", "soft", "rigid", "nodes"});
            constraint.m_a = softName(at["soft"]);
            constraint.m_b = rigidName(at["rigid"]);
            constraint.m_box = readBox(at["nodes"]);
        }
        else
        {
            at.onlyMembers({"kind", "body", "to", "pivot", "axis", "speed", "torque", "force"});
            constraint.m_a = rigidName(at["body"]);
            if (at.has("to")) constraint.m_b = rigidName(at["to"]);
            constraint.m_pivot = at["pivot"].vector(kPlace);
            const bool turns = constraint.m_kind == SceneConstraint::Kind::hinge;
            const bool slides = constraint.m_kind == SceneConstraint::Kind::slider;
            for (const char* name : {"axis", "speed"})
                if (!turns && !slides && at.has(name))
                    at[name].fail("is given, but only a hinge or slider has one; leave it out");
            if (!turns && at.has("torque")) at["torque"].fail("is given, but only a hinge has one; leave it out");
            if (!slides && at.has("force")) at["force"].fail("is given, but only a slider has one; leave it out");
            at.readDirection("axis", constraint.m_axis);
            if (at.has("speed")) constraint.m_speed = readCurve(at["speed"], kSpeed);
            at.read(turns ? "torque" : "force", kNotNegative, constraint.m_max);
        }
        m_scene.m_constraints.push_back(std::move(constraint));
    }

    void addWeld(const JsonCursor& at)
    {
        m_scene.m_welds.push_back(readWeld(at));
        if (softName(at["a"]) == softName(at["b"])) at["b"].fail("is 'a', too; weld it to another body");
    }

    void readForce(const JsonCursor& at)
    {
        at.onlyMembers({"body", "nodes", "force", "from", "to"});
        SceneForce force;
        force.m_body = at["body"].text();
        if (!isSoft(force.m_body) && !isRigid(force.m_body)) at["body"].expected("the name of a body");
        if (at.has("nodes"))
        {
            if (!isSoft(force.m_body)) at["nodes"].fail("is given, but only soft bodies have nodes");
            force.m_everywhere = false;
            force.m_box = readBox(at["nodes"]);
        }
        force.m_force = at["force"].vector(kAnyForce);
        readTimes(at, force.m_from, force.m_to);
        m_scene.m_forces.push_back(std::move(force));
    }

    static void readTimes(const JsonCursor& at, double& from, double& to)
    {
        at.read("from", kTime, from);
        at.read("to", kTime, to);
        if (from > to) at["to"].fail("is before 'from'");
    }

    void readSpring(const JsonCursor& at)
    {
        at.onlyMembers({"body", "at", "target", "stiffness", "damping", "force", "from", "to"});
        SceneSpring spring;
        spring.m_body = softName(at["body"]);
        spring.m_at = at["at"].vector(kPlace);
        spring.m_target = readVectorCurve(at["target"], kPlace);
        spring.m_stiffness = at["stiffness"].number(kSpringRange);
        at.read("damping", kSpringRange, spring.m_damping);
        at.read("force", kSpringRange, spring.m_max);
        readTimes(at, spring.m_from, spring.m_to);
        m_scene.m_springs.push_back(std::move(spring));
    }

    void addActuator(const JsonCursor& at)
    {
        m_scene.m_actuators.push_back(readActuator(at));
        const std::string name = softName(at["body"]);
        const SceneActuator::Kind kind = m_scene.m_actuators.back().m_kind;
        const bool isOfNodes = kind == SceneActuator::Kind::chamber || kind == SceneActuator::Kind::cable;
        for (const SceneSoftBody& body : m_scene.m_softBodies)
        {
            if (body.m_name != name) continue;
            if (body.m_pieces.m_cells > 0)
                at["body"].fail("is a body in pieces; actuators are in bodies that are in one");
            if (isOfNodes && body.m_fracture.m_tension > 0)
                at["body"].fail("is a body that splits, which loses chambers and cables; leave out its 'fracture'");
        }
    }

    void addSensor(const JsonCursor& at)
    {
        const SceneSensor sensor = readSensor(at);
        for (const SceneSensor& other : m_scene.m_sensors)
            if (other.m_name == sensor.m_name) at["name"].expected("a name that no other sensor has");
        softName(at["body"]);
        if (at.has("to")) rigidName(at["to"]);
        m_scene.m_sensors.push_back(sensor);
    }

    void readCamera(const JsonCursor& at)
    {
        at.onlyMembers({"direction", "eye", "target", "fieldOfView"});
        SceneCamera& camera = m_scene.m_camera;
        if (at.has("eye") != at.has("target")) at.fail("needs both 'eye' and 'target', or 'direction'");
        if (at.has("eye") && at.has("direction")) at.fail("has 'eye' and 'direction'; give one of them");
        camera.m_placed = at.has("eye");
        at.read("eye", kPlace, camera.m_eye);
        at.read("target", kPlace, camera.m_target);
        if (camera.m_placed && !(norm(camera.m_eye - camera.m_target) > 1e-9))
            at["target"].fail("is where 'eye' is; they must differ");
        at.readDirection("direction", camera.m_direction);
        if (at.has("fieldOfView")) camera.m_fieldOfView = at["fieldOfView"].number({1, 150}) * kRadians;
    }

    void readPictures(const JsonCursor& at)
    {
        at.onlyMembers({"width", "height", "stress", "hottest", "forces", "wireframe"});
        at.read("width", 16, 8192, m_scene.m_pictures.m_width);
        at.read("height", 16, 8192, m_scene.m_pictures.m_height);
        at.read("stress", m_scene.m_pictures.m_stress);
        at.read("hottest", kNotNegative, m_scene.m_pictures.m_hottest);
        at.read("forces", m_scene.m_pictures.m_forces);
        at.read("wireframe", m_scene.m_pictures.m_wireframe);
    }

    SceneDescription m_scene;
    SceneMaterials m_materials = presetMaterials();
};

}  // namespace

SceneDescription parseScene(const std::string& json, const std::string& folder)
{
    const nlohmann::json document = parseJson(json);
    return SceneReader(folder).read(JsonCursor(document, ""));
}

SceneDescription readScene(const std::string& path)
{
    try
    {
        std::error_code ignored;
        if (!std::filesystem::is_regular_file(path, ignored)) throw std::runtime_error("there is no such file");
        std::ifstream file(path, std::ios::binary);
        const std::string json(std::istreambuf_iterator<char>(file), {});
        if (!file) throw std::runtime_error("it cannot be read; check its permissions");
        return parseScene(json, std::filesystem::path(path).parent_path().string());
    }
    catch (const JsonSyntaxError& error)
    {
        throw std::runtime_error(message(path, ":", error.line(), ":", error.column(), ": ", error.message()));
    }
    catch (const std::exception& error)
    {
        throw std::runtime_error("cannot read the scene '" + path + "': " + reasonOf(error));
    }
}

}  // namespace bullet_fem

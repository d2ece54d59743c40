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
#include "tools/scene/scene_actuator_reader.h"
#include "tools/scene/scene_materials.h"
#include "tools/scene/scene_place_reader.h"
#include "tools/scene/scene_regions.h"
#include "tools/scene/scene_weld_reader.h"

namespace bullet_fem
{
namespace
{

constexpr double kRadians = 3.14159265358979323846 / 180;
constexpr JsonRange kLength = {0, 1e6, true}, kPlace = {-1e6, 1e6}, kSpeed = {-1e4, 1e4}, kShare = {0, 1},
                    kNotNegative = {0, 1e30}, kAnyForce = {-1e12, 1e12}, kTime = {0, 1e30};

/// Reads the document that lies in one folder.
class SceneReader
{
public:
    explicit SceneReader(std::string folder) { m_scene.m_folder = std::move(folder); }

    SceneDescription read(const JsonCursor& at)
    {
        at.onlyMembers({"$schema", "title", "gravity", "step", "seconds", "framesPerSecond", "solver", "materials",
                        "softBodies", "rigidBodies", "constraints", "welds", "forces", "actuators", "camera",
                        "pictures"});
        std::string schema;  // for editors
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
        at.forEach("actuators", [&](const JsonCursor& item) { addActuator(item); });
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

    std::string file(const JsonCursor& at) const
    {
        const std::filesystem::path path = std::filesystem::path(m_scene.m_folder) / at.text();
        std::error_code ignored;
        if (!std::filesystem::is_regular_file(path, ignored))
            at.fail("names '" + path.string() + "', which is no file");
        return path.string();
    }

    // A name that no other body has.
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

    SceneMesh mesh(const JsonCursor& at) const
    {
        at.onlyMembers({"box", "sphere", "surface", "tetrahedra", "baked", "holes", "cell", "tets", "grade", "levels",
                        "scale", "surfaceCollides"});
        SceneMesh mesh;
        const int kinds = at.has("box") + at.has("sphere") + at.has("surface") + at.has("tetrahedra") + at.has("baked");
        if (kinds != 1) at.fail("must have one of: box, sphere, surface, tetrahedra, baked");
        if (at.has("box"))
            mesh.m_size = at["box"].vector(kLength);
        else if (at.has("sphere"))
        {
            mesh.m_kind = SceneMesh::Kind::sphere;
            mesh.m_radius = at["sphere"].number(kLength);
        }
        else
        {
            const bool surface = at.has("surface"), baked = at.has("baked");
            mesh.m_kind = surface ? SceneMesh::Kind::surface
                          : baked ? SceneMesh::Kind::baked
                                  : SceneMesh::Kind::tetrahedra;
            mesh.m_path = file(at[surface ? "surface" : baked ? "baked" : "tetrahedra"]);
        }
        if (mesh.m_kind != SceneMesh::Kind::box && at.has("holes"))
            at["holes"].fail("are given, but only a 'box' has some; leave them out");
        at.forEach("holes", [&](const JsonCursor& item) { mesh.m_holes.push_back(readBox(item)); });
        const bool hasElements = mesh.m_kind == SceneMesh::Kind::tetrahedra || mesh.m_kind == SceneMesh::Kind::baked;
        for (const char* name : {"cell", "tets"})
            if (hasElements && at.has(name)) at[name].fail("is given, but the file has its elements; leave it out");
        for (const char* name : {"grade", "levels"})
            if (mesh.m_kind != SceneMesh::Kind::surface && at.has(name))
                at[name].fail("is given, but only cages around a surface are graded; leave it out");
        if (at.has("levels") && !at.has("grade")) at["levels"].fail("is given without 'grade'; give that, too");
        if (mesh.m_kind == SceneMesh::Kind::baked && at.has("scale"))
            at["scale"].fail("is given, but a baked body has its size; leave it out, or bake it anew");
        if (at.has("cell") && at.has("tets")) at.fail("has 'cell' and 'tets'; give one of them");
        at.read("cell", kLength, mesh.m_cellSize);
        at.read("tets", 5, 5000000, mesh.m_tets);
        at.read("grade", {0.5, 8}, mesh.m_cellsAcross);
        at.read("levels", 1, 6, mesh.m_mostLevels);
        at.read("scale", {0, 1e9, true}, mesh.m_scale);
        if (mesh.m_kind != SceneMesh::Kind::surface && at.has("surfaceCollides"))
            at["surfaceCollides"].fail("is for a 'surface' with a cage around it; a baked body has it from baking");
        at.read("surfaceCollides", mesh.m_surfaceCollides);
        return mesh;
    }

    void readSoftBody(const JsonCursor& at)
    {
        at.onlyMembers({"name", "mesh", "position", "rotation", "velocity", "material", "materials", "friction",
                        "restitution", "selfContact", "colour", "pins", "pieces"});
        SceneSoftBody body;
        body.m_name = name(at);
        body.m_material = defaultMaterial();
        body.m_mesh = mesh(at["mesh"]);
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
        m_scene.m_softBodies.push_back(std::move(body));
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
            const JsonCursor round = at[at.has("cylinder") ? "cylinder" : "capsule"];
            round.onlyMembers({"radius", "height"});
            shape.m_radius = round["radius"].number(kLength);
            shape.m_height = round["height"].number(kLength);
        }
        return shape;
    }

    void readRigidBody(const JsonCursor& at)
    {
        at.onlyMembers(
            {"name", "shape", "mass", "position", "rotation", "velocity", "spin", "friction", "restitution", "colour"});
        SceneRigidBody body;
        body.m_name = name(at);
        body.m_shape = shape(at["shape"]);
        at.read("mass", {0, 1e9}, body.m_mass);
        if (body.m_shape.m_kind == SceneShape::Kind::plane && body.m_mass > 0)
            at["mass"].fail("is given for a plane, which stands still; leave it out");
        readPose(at, body.m_pose);
        at.read("velocity", kSpeed, body.m_velocity);
        at.read("spin", kSpeed, body.m_spin);
        at.read("friction", {0, 10}, body.m_friction);
        at.read("restitution", kShare, body.m_restitution);
        at.read("colour", kShare, body.m_colour);
        m_scene.m_rigidBodies.push_back(std::move(body));
    }

    void readConstraint(const JsonCursor& at)
    {
        SceneConstraint constraint;
        constraint.m_kind = static_cast<SceneConstraint::Kind>(at["kind"].choice({"anchor", "point", "hinge"}));
        if (constraint.m_kind == SceneConstraint::Kind::anchor)
        {
            at.onlyMembers({"kind", "soft", "rigid", "nodes"});
            constraint.m_a = softName(at["soft"]);
            constraint.m_b = rigidName(at["rigid"]);
            constraint.m_box = readBox(at["nodes"]);
        }
        else
        {
            at.onlyMembers({"kind", "body", "to", "pivot", "axis", "speed", "torque"});
            constraint.m_a = rigidName(at["body"]);
            if (at.has("to")) constraint.m_b = rigidName(at["to"]);
            constraint.m_pivot = at["pivot"].vector(kPlace);
            for (const char* name : {"axis", "speed", "torque"})
                if (constraint.m_kind == SceneConstraint::Kind::point && at.has(name))
                    at[name].fail("is given, but only a hinge has one; leave it out");
            at.readDirection("axis", constraint.m_axis);
            at.read("speed", kSpeed, constraint.m_speed);
            at.read("torque", kNotNegative, constraint.m_torque);
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
        at.read("from", kTime, force.m_from);
        at.read("to", kTime, force.m_to);
        if (force.m_from > force.m_to) at["to"].fail("is before 'from'");
        m_scene.m_forces.push_back(std::move(force));
    }

    void addActuator(const JsonCursor& at)
    {
        m_scene.m_actuators.push_back(readActuator(at));
        const std::string name = softName(at["body"]);
        for (const SceneSoftBody& body : m_scene.m_softBodies)
            if (body.m_name == name && body.m_pieces.m_cells > 0)
                at["body"].fail("is a body in pieces; actuators are in bodies that are in one");
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
    catch (const std::exception& error)
    {
        throw std::runtime_error("cannot read the scene '" + path + "': " + reasonOf(error));
    }
}

}  // namespace bullet_fem

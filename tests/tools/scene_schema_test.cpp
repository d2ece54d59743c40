// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// docs/scene.schema.json and the reader agree: on the members of each object, and on thousands of scenes that differ
// from valid ones in one place.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <set>
#include <valijson/adapters/nlohmann_json_adapter.hpp>
#include <valijson/schema.hpp>
#include <valijson/schema_parser.hpp>
#include <valijson/validator.hpp>

#include "tools/scene/scene_reader.h"
#include "tools/scene_samples.h"

namespace bullet_fem
{
namespace
{

using nlohmann::json;
using valijson::adapters::NlohmannJsonAdapter;

json schemaDocument()
{
    std::ifstream file(BULLETFEM_SCHEMA);
    return json::parse(file);
}

/// An object of a sample scene, and its schema.
struct SchemaPlace
{
    bool m_full;  ///< in fullScene, else in otherScene
    const char* m_at;
    const char* m_inSchema;
};

// All objects with members of their own; the first test checks that the list is complete.
const SchemaPlace kObjects[] = {{true, "", ""},
                                {true, "/solver", "/properties/solver"},
                                {true, "/materials/gum", "/definitions/material"},
                                {true, "/materials/timber/loss", "/definitions/loss"},
                                {true, "/materials/gum/relaxation/0", "/definitions/relaxationTerm"},
                                {true, "/materials/timber/orthotropic", "/definitions/orthotropic"},
                                {true, "/softBodies/0", "/definitions/softBody"},
                                {true, "/softBodies/0/material", "/definitions/material"},
                                {true, "/softBodies/0/mesh", "/definitions/mesh"},
                                {true, "/softBodies/1/mesh", "/definitions/mesh"},
                                {false, "/softBodies/0/mesh", "/definitions/mesh"},
                                {false, "/softBodies/1/mesh", "/definitions/mesh"},
                                {false, "/softBodies/3/mesh", "/definitions/mesh"},
                                {false, "/softBodies/4/mesh", "/definitions/mesh"},
                                {false, "/softBodies/4/mesh/cylinder", "/definitions/round"},
                                {false, "/softBodies/1", "/definitions/softBody"},
                                {true, "/softBodies/0/rotation", "/definitions/rotation"},
                                {true, "/softBodies/0/pins/0", "/definitions/box"},
                                {true, "/rigidBodies/0", "/definitions/rigidBody"},
                                {true, "/rigidBodies/0/shape", "/definitions/shape"},
                                {true, "/rigidBodies/0/shape/capsule", "/definitions/round"},
                                {true, "/rigidBodies/1", "/definitions/rigidBody"},
                                {false, "/rigidBodies/0", "/definitions/rigidBody"},
                                {false, "/rigidBodies/1/shape", "/definitions/shape"},
                                {false, "/rigidBodies/2/shape/cylinder", "/definitions/round"},
                                {true, "/constraints/0", "/definitions/anchor"},
                                {true, "/constraints/0/nodes", "/definitions/box"},
                                {true, "/constraints/1", "/definitions/joint"},
                                {false, "/constraints/0", "/definitions/joint"},
                                {true, "/welds/0", "/definitions/weld"},
                                {false, "/softBodies/3/pieces", "/definitions/pieces"},
                                {false, "/softBodies/4/fracture", "/definitions/fracture"},
                                {false, "/softBodies/5/copies", "/definitions/copies"},
                                {false, "/constraints/1", "/definitions/joint"},
                                {true, "/forces/0", "/definitions/force"},
                                {true, "/forces/0/nodes", "/definitions/box"},
                                {false, "/forces/0", "/definitions/force"},
                                {true, "/springs/0", "/definitions/spring"},
                                {true, "/softBodies/0/mesh/holes/0", "/definitions/box"},
                                {true, "/actuators/0", "/definitions/chamber"},
                                {true, "/actuators/1", "/definitions/cable"},
                                {false, "/actuators/0", "/definitions/cable"},
                                {true, "/actuators/2", "/definitions/fibres"},
                                {true, "/actuators/2/region", "/definitions/box"},
                                {true, "/actuators/3", "/definitions/expansion"},
                                {true, "/sensors/0", "/definitions/sensor"},
                                {true, "/sensors/0/nodes", "/definitions/box"},
                                {true, "/sensors/1", "/definitions/sensor"},
                                {true, "/camera", "/definitions/camera"},
                                {false, "/camera", "/definitions/camera"},
                                {true, "/pictures", "/definitions/pictures"}};

class SceneSchema : public testing::Test
{
protected:
    SceneSchema()
    {
        writeSampleMeshes(m_folder);
        valijson::SchemaParser(valijson::SchemaParser::kDraft7)
            .populateSchema(NlohmannJsonAdapter(m_document), m_schema);
    }

    json sample(bool full) const { return json::parse(full ? fullScene() : otherScene()); }

    /// The reader's error message; empty if it accepts the scene.
    std::string refusal(const json& scene) const
    {
        try
        {
            parseScene(scene.dump(), m_folder.path(""));
            return "";
        }
        catch (const std::runtime_error& error)
        {
            return error.what();
        }
    }
    bool isValid(const json& scene) const
    {
        return valijson::Validator().validate(m_schema, NlohmannJsonAdapter(scene), nullptr);
    }

    /// Expects that schema and reader agree, or that the reader rejects a scene for a reason that a schema cannot
    /// express.
    void compare(const json& scene, const std::string& what)
    {
        const std::string said = refusal(scene);
        const bool valid = isValid(scene);
        ++(valid ? m_valid : m_invalid);
        if (valid == said.empty()) return;
        // Reasons that a schema cannot express. A `like` material may supply the yield stress.
        static const char* const kMeanings[] = {"a name that no other body has",
                                                "must be the name of a",
                                                "which is no file",
                                                "has a 'low' above its 'high'",
                                                "is before 'from'",
                                                "is where 'eye' is",
                                                "must have a length",
                                                "weld it to another body",
                                                "puts the last copy beyond",
                                                "accurate bending does not go with",  // of the `like` material, too
                                                "is no material: orthotropic",        // inconsistent numbers
                                                "is no damping",                      // with the mass damping
                                                "with the orthotropic law",           // which may come from `like`
                                                "only soft bodies have nodes"};
        const bool isMeaning =
            std::any_of(std::begin(kMeanings), std::end(kMeanings),
                        [&](const char* meaning) { return said.find(meaning) != std::string::npos; });
        EXPECT_TRUE(valid && isMeaning) << what << ": the schema says " << valid << ", the reader '" << said << "'";
    }

    TemporaryFolder m_folder;
    const json m_document = schemaDocument();
    valijson::Schema m_schema;
    int m_valid = 0, m_invalid = 0;
};

std::set<std::string> namesOf(const json& object)
{
    std::set<std::string> names;
    for (const auto& [name, value] : object.items()) names.insert(name);
    return names;
}

TEST_F(SceneSchema, KnowsTheMembersOfTheReader)
{
    for (const SchemaPlace& place : kObjects)
    {
        json scene = sample(place.m_full);
        scene[json::json_pointer(place.m_at)]["unheardOf"] = 1;
        const std::string said = refusal(scene), before = "those that are: ";
        ASSERT_NE(said.find(before), std::string::npos) << place.m_at << ": " << said;
        std::set<std::string> known;
        std::stringstream list(said.substr(said.find(before) + before.size()));
        for (std::string name; std::getline(list >> std::ws, name, ',');) known.insert(name);
        EXPECT_EQ(namesOf(m_document.at(json::json_pointer(place.m_inSchema))["properties"]), known) << place.m_at;
        EXPECT_FALSE(isValid(scene)) << place.m_at;
    }
}

TEST_F(SceneSchema, HasNoObjectMissingFromTheTest)
{
    std::set<std::string> objects, seen;
    const json flat = m_document.flatten();
    for (const auto& [at, value] : flat.items())
        if (const std::size_t end = at.rfind("/additionalProperties"); end != std::string::npos && value == false)
            objects.insert(at.substr(0, end));
    for (const SchemaPlace& place : kObjects) seen.insert(place.m_inSchema);
    EXPECT_EQ(objects, seen);
}

TEST_F(SceneSchema, TakesTheSamples)
{
    for (const bool full : {true, false})
    {
        EXPECT_EQ(refusal(sample(full)), "");
        EXPECT_TRUE(isValid(sample(full)));
    }
}

// Each limit of the schema, values close to it on both sides, and values of all types.
std::vector<json> valuesToTry(const json& schema)
{
    std::set<double> numbers = {0, 1e-12, -1e-12, 0.5, 1.5};
    const json flat = schema.flatten();
    for (const auto& [at, value] : flat.items())
        if (const std::string last = at.substr(at.rfind('/') + 1);
            last == "minimum" || last == "maximum" || last == "exclusiveMinimum")
            for (const double factor : {1 - 1e-6, 1., 1 + 1e-6}) numbers.insert(factor * value.get<double>());
    std::vector<json> values = {nullptr,
                                true,
                                "",
                                "hammer",
                                "block",
                                "gum",
                                "cube.off",
                                "anchor",
                                "point",
                                "hinge",
                                "slider",
                                json::array(),
                                json::object(),
                                json::array({1, 2}),
                                json::array({1, 2, 3, 4}),
                                json::array({1, "2", 3}),
                                {{"low", {0, 0, 0}}, {"high", {1, 1, 1}}},
                                {{"radius", 1}, {"height", 2}},
                                {{"box", {1, 1, 1}}},
                                {{"young", 1e5}},
                                {{"baked", "body.bfem"}},
                                {{"plane", {0, 1, 0}}}};
    for (const double number : numbers)
    {
        const bool whole = number == std::floor(number) && std::abs(number) < 1e15;
        values.push_back(whole ? json(static_cast<std::int64_t>(number)) : json(number));
        values.push_back(json::array({0.25, values.back(), 0.75}));
    }
    return values;
}

TEST_F(SceneSchema, AgreesWithTheReaderOnEveryValue)
{
    const std::vector<json> values = valuesToTry(m_document);
    for (const bool full : {true, false})
    {
        std::set<std::string> places;
        const json flat = sample(full).flatten();
        for (const auto& [place, value] : flat.items())
            for (std::string at = place; !at.empty(); at.erase(at.rfind('/'))) places.insert(at);
        for (const std::string& at : places)
        {
            json scene = sample(full);
            for (const json& value : values)
            {
                scene[json::json_pointer(at)] = value;
                compare(scene, at + " = " + value.dump());
            }
            json less = sample(full);
            const json::json_pointer place(at);
            json& parent = less[place.parent_pointer()];
            if (parent.is_object()) parent.erase(place.back());
            compare(less, at + " left out");
        }
    }
    EXPECT_GT(m_valid, 1500);
    EXPECT_GT(m_invalid, 5000);
}

TEST_F(SceneSchema, AgreesWithTheReaderOnEveryAddedMember)
{
    const std::vector<json> values = {0,
                                      0.5,
                                      5,
                                      true,
                                      "cube.off",
                                      "anvil",
                                      "gum",
                                      "hinge",
                                      json::array({1, 2, 3}),
                                      json::array({0.1, 0.2, 0.3}),
                                      {{"low", {0, 0, 0}}, {"high", {1, 1, 1}}},
                                      {{"radius", 1}, {"height", 2}},
                                      {{"axis", {0, 1, 0}}, {"degrees", 5}},
                                      json::array({{{"low", {0, 0, 0}}, {"high", {1, 1, 1}}}})};
    for (const SchemaPlace& place : kObjects)
        for (const std::string& name : namesOf(m_document.at(json::json_pointer(place.m_inSchema))["properties"]))
            for (const json& value : values)
            {
                json scene = sample(place.m_full);
                scene[json::json_pointer(place.m_at)][name] = value;
                compare(scene, std::string(place.m_at) + '/' + name + " = " + value.dump());
            }
    EXPECT_GT(m_valid, 200);
    EXPECT_GT(m_invalid, 1000);
}

// The scene as text with defaults filled in, for comparison.
std::string written(const SceneDescription& scene)
{
    json all = {scene.m_title,   scene.m_step,      scene.m_seconds,          scene.m_framesPerSecond,
                scene.m_coupled, scene.m_tolerance, scene.m_contactTolerance, scene.m_threads};
    const auto add = [&](const Vec3& x) { all.insert(all.end(), {x.x, x.y, x.z}); };
    add(scene.m_gravity);
    for (const SceneSoftBody& body : scene.m_softBodies)
    {
        const Material& m = body.m_material;
        all.insert(all.end(),
                   {m.m_youngModulus, m.m_poissonRatio, m.m_density, m.m_massDamping, m.m_stiffnessDamping,
                    double(m.m_meanDilatation), double(m.m_bending), body.m_mesh.m_cellSize, double(body.m_mesh.m_tets),
                    double(body.m_mesh.m_mostLevels), body.m_mesh.m_scale, body.m_friction, body.m_restitution,
                    double(body.m_selfContact), double(body.m_mesh.m_surfaceCollides)});
        for (const Vec3& x : {body.m_pose.m_position, body.m_pose.m_axis, body.m_velocity, body.m_colour}) add(x);
        all.insert(all.end(), {double(body.m_pieces.m_seed), body.m_pieces.m_strength.m_compliance});
        all.insert(all.end(), {body.m_fracture.m_mostCracks, int(body.m_fracture.m_partsTouch)});
    }
    for (const SceneWeld& weld : scene.m_welds) all.push_back(weld.m_strength.m_compliance);
    for (const SceneRigidBody& body : scene.m_rigidBodies)
    {
        all.insert(all.end(), {body.m_mass, body.m_friction, body.m_restitution});
        for (const Vec3& x : {body.m_pose.m_position, body.m_colour}) add(x);
        for (const SceneVectorCurve* motion : {&body.m_velocity, &body.m_spin})
            for (const SceneVectorCurve::Point& point : motion->m_points) add(point.m_value);
    }
    for (const SceneConstraint& constraint : scene.m_constraints)
    {
        for (const SceneCurve::Point& point : constraint.m_speed.m_points) all.push_back(point.m_value);
        all.push_back(constraint.m_max);
        add(constraint.m_axis);
    }
    for (const SceneForce& force : scene.m_forces) all.insert(all.end(), {force.m_from, force.m_to});
    for (const SceneSpring& spring : scene.m_springs)
        all.insert(all.end(), {spring.m_damping, spring.m_max, spring.m_from, spring.m_to});
    for (const SceneActuator& actuator : scene.m_actuators) all.push_back(actuator.m_sealedFrom);
    const ScenePictures& pictures = scene.m_pictures;
    all.insert(all.end(), {pictures.m_width, pictures.m_height, int(pictures.m_stress), int(pictures.m_forces),
                           int(pictures.m_wireframe)});
    all.insert(all.end(), {pictures.m_hottest, std::round(1e4 * scene.m_camera.m_fieldOfView) / 1e4});
    add(scene.m_camera.m_direction);
    return all.dump();
}

// A member that is left out has the schema's default, not its former value.
TEST_F(SceneSchema, HasTheReadersDefaults)
{
    int count = 0;
    for (const SchemaPlace& place : kObjects)
        for (const auto& [name, property] : m_document.at(json::json_pointer(place.m_inSchema))["properties"].items())
        {
            json scene = sample(place.m_full), &object = scene[json::json_pointer(place.m_at)];
            object.erase("like");  // its values are inherited otherwise
            // The user of gum has values of its own, and nothing uses timber: SceneReader knows its defaults.
            const bool isSeen = std::string(place.m_at).rfind("/materials/", 0) != 0;
            if (!property.contains("default") || !object.contains(name) || !isSeen) continue;
            const std::string before = written(parseScene(scene.dump(), m_folder.path("")));
            object.erase(name);
            const std::string without = written(parseScene(scene.dump(), m_folder.path("")));
            object[name] = property["default"];
            EXPECT_EQ(written(parseScene(scene.dump(), m_folder.path(""))), without) << place.m_at << '/' << name;
            EXPECT_NE(without, before) << place.m_at << '/' << name;
            ++count;
        }
    EXPECT_GE(count, 40);
}

TEST_F(SceneSchema, HasTheMembersOfItsDocument)
{
    std::ifstream file(BULLETFEM_SCENES_DOCUMENT);
    const std::string text(std::istreambuf_iterator<char>(file), {});
    for (const SchemaPlace& place : kObjects)
        for (const std::string& name : namesOf(m_document.at(json::json_pointer(place.m_inSchema))["properties"]))
            EXPECT_TRUE(text.find('`' + name + '`') != std::string::npos ||
                        text.find('"' + name + '"') != std::string::npos)
                << place.m_at << '/' << name;
    const std::string begin = "```json\n";
    const std::size_t at = text.find(begin) + begin.size();
    const json example = json::parse(text.substr(at, text.find("```", at) - at));
    EXPECT_EQ(refusal(example), "") << "the document's example";
    EXPECT_TRUE(isValid(example));
}

class DemoScene : public testing::TestWithParam<const char*>
{
};

TEST_P(DemoScene, IsRead)
{
    const std::string path = BULLETFEM_SCENES "/" + std::string(GetParam()) + ".json";
    const SceneDescription scene = readScene(path);
    EXPECT_FALSE(scene.m_title.empty());
    EXPECT_FALSE(scene.m_softBodies.empty());
}

std::string nameOf(const testing::TestParamInfo<const char*>& info)
{
    return info.param;
}

INSTANTIATE_TEST_SUITE_P(Demos, DemoScene,
                         testing::Values("beam", "press", "hammer", "locking", "bending", "relax", "crush", "plate"),
                         nameOf);

// The elephant exists only after demos/run.sh has fetched it; the rest of the scene is checked without it.
TEST_F(SceneSchema, TheMainDemosSceneIsRead)
{
    std::ifstream file(BULLETFEM_SCENES "/drop.json");
    json scene = json::parse(file, nullptr, true, true);
    EXPECT_TRUE(isValid(scene));
    std::string& surface = scene["softBodies"][0]["mesh"]["surface"].get_ref<std::string&>();
    EXPECT_EQ(surface, "../../build/release/data/meshes/elephant.off");
    surface = "cube.off";
    EXPECT_EQ(refusal(scene), "");
}

TEST_F(SceneSchema, TakesTheDemosScenes)
{
    for (const char* name :
         {"beam", "press", "hammer", "../balls/balls", "../bridge/bridge", "../car/car", "../crowd/crowd",
          "../dents/dents", "../finger/finger", "../gripper/gripper", "../squeeze/squeeze", "../tearing/tearing",
          "../throw/throw", "../tower/tower", "../walker/walker"})
    {
        std::ifstream file(BULLETFEM_SCENES "/" + std::string(name) + ".json");
        EXPECT_TRUE(isValid(json::parse(file, nullptr, true, true))) << name;
    }
}

}  // namespace
}  // namespace bullet_fem

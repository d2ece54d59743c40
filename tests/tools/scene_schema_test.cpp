// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
// docs/scene.schema.json and the reader agree: on the members of every object, and on thousands of scenes that differ
// from good ones in one place.
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

/// An object of a sample scene, and what the schema says of it.
struct SchemaPlace
{
    bool m_full;  ///< in fullScene, else in otherScene
    const char* m_at;
    const char* m_inSchema;
};

// All objects with members of their own: the first test says so.
const SchemaPlace kObjects[] = {{true, "", ""},
                                {true, "/solver", "/properties/solver"},
                                {true, "/materials/gum", "/definitions/material"},
                                {true, "/softBodies/0", "/definitions/softBody"},
                                {true, "/softBodies/0/material", "/definitions/material"},
                                {true, "/softBodies/0/mesh", "/definitions/mesh"},
                                {true, "/softBodies/1/mesh", "/definitions/mesh"},
                                {false, "/softBodies/0/mesh", "/definitions/mesh"},
                                {false, "/softBodies/1/mesh", "/definitions/mesh"},
                                {false, "/softBodies/1", "/definitions/softBody"},
                                {true, "/softBodies/0/rotation", "/definitions/rotation"},
                                {true, "/softBodies/0/pins/0", "/definitions/box"},
                                {true, "/rigidBodies/0", "/definitions/rigidBody"},
                                {true, "/rigidBodies/0/shape", "/definitions/shape"},
                                {true, "/rigidBodies/0/shape/capsule", "/definitions/round"},
                                {false, "/rigidBodies/0", "/definitions/rigidBody"},
                                {false, "/rigidBodies/1/shape", "/definitions/shape"},
                                {false, "/rigidBodies/2/shape/cylinder", "/definitions/round"},
                                {true, "/constraints/0", "/definitions/anchor"},
                                {true, "/constraints/0/nodes", "/definitions/box"},
                                {true, "/constraints/1", "/definitions/joint"},
                                {false, "/constraints/0", "/definitions/joint"},
                                {true, "/forces/0", "/definitions/force"},
                                {true, "/forces/0/nodes", "/definitions/box"},
                                {false, "/forces/0", "/definitions/force"},
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

    /// What the reader says; nothing if it takes the scene.
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

    /// The schema and the reader are of one mind, or the reader refuses what no schema can know.
    void compare(const json& scene, const std::string& what)
    {
        const std::string said = refusal(scene);
        const bool valid = isValid(scene);
        ++(valid ? m_valid : m_invalid);
        if (valid == said.empty()) return;
        static const char* const kMeanings[] = {"a name that no other body has",
                                                "must be the name of a",
                                                "which is no file",
                                                "has a 'low' above its 'high'",
                                                "is before 'from'",
                                                "is where 'eye' is",
                                                "must have a length",
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

TEST_F(SceneSchema, KnowsTheMembersThatTheReaderKnows)
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

TEST_F(SceneSchema, HasNoObjectThatIsNotLookedAtHere)
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

// Every limit of the schema and what lies close to it on both sides, and values of all kinds.
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

TEST_F(SceneSchema, AgreesWithTheReaderOnEveryMemberThatIsAdded)
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

INSTANTIATE_TEST_SUITE_P(Demos, DemoScene, testing::Values("beam", "press", "hammer"), nameOf);

// The elephant is there only when demos/run.sh has fetched it; the rest of the scene is looked at without it.
TEST_F(SceneSchema, TheMainDemosSceneIsRead)
{
    std::ifstream file(BULLETFEM_SCENES "/drop.json");
    json scene = json::parse(file, nullptr, true, true);
    EXPECT_TRUE(isValid(scene));
    std::string& surface = scene["softBodies"][0]["mesh"]["surface"].get_ref<std::string&>();
    EXPECT_EQ(surface, "../../build/demo/data/meshes/elephant.off");
    surface = "cube.off";
    EXPECT_EQ(refusal(scene), "");
}

TEST_F(SceneSchema, TakesTheDemosScenes)
{
    for (const char* name : {"beam", "press", "hammer"})
    {
        std::ifstream file(BULLETFEM_SCENES "/" + std::string(name) + ".json");
        EXPECT_TRUE(isValid(json::parse(file, nullptr, true, true))) << name;
    }
}

}  // namespace
}  // namespace bullet_fem

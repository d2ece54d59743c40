// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// Randomly damaged scenes are read, or rejected with a message.
#include <gtest/gtest.h>

#include <array>
#include <nlohmann/json.hpp>
#include <random>

#include "tools/scene/scene_reader.h"
#include "tools/scene_samples.h"

namespace bullet_fem
{
namespace
{

using nlohmann::json;

class SceneMutation : public testing::Test
{
protected:
    SceneMutation() { writeSampleMeshes(m_folder); }

    int below(std::size_t count) { return static_cast<int>(m_random() % count); }

    /// Reads the text, and returns whether it is a valid scene.
    bool isScene(const std::string& text)
    {
        try
        {
            const SceneDescription scene = parseScene(text, m_folder.path(""));
            EXPECT_FALSE(scene.m_softBodies.empty() && scene.m_rigidBodies.empty()) << text;
            return true;
        }
        catch (const std::runtime_error& error)
        {
            EXPECT_GT(std::string(error.what()).size(), 10u) << text;
            EXPECT_LT(std::string(error.what()).size(), 2000u) << text;
            return false;
        }
    }

    TemporaryFolder m_folder;
    std::mt19937 m_random{1};
};

TEST_F(SceneMutation, MutatedBytesAreReadOrRejected)
{
    static const std::string pool = "{}[]\",:0123456789.-+eE \n\\/*truefalsn\0\x7f\xff\xc3\xed";
    int scenes = 0;
    for (int run = 0; run < 10000; ++run)
    {
        std::string text = run % 2 ? fullScene() : otherScene();
        for (int k = below(4); k >= 0; --k)
        {
            const std::size_t at = below(text.size());
            switch (below(5))
            {
                case 0:
                    text[at] = pool[below(pool.size())];
                    break;
                case 1:
                    text.insert(at, 1, pool[below(pool.size())]);
                    break;
                case 2:
                    text.erase(at, 1 + below(8));
                    break;
                case 3:
                    text.insert(at, text.substr(below(text.size()), 1 + below(60)));
                    break;
                default:
                    text.resize(below(50) ? text.size() : at);
                    break;
            }
            if (text.empty()) text = "{";
        }
        scenes += isScene(text);
    }
    EXPECT_GT(scenes, 500) << "most would be refused by the JSON parser alone";
    EXPECT_LT(scenes, 9000);
}

/// JSON values that are wrong at any place.
const std::array<const char*, 24> kValues = {"null",
                                             "true",
                                             "0",
                                             "-1",
                                             "1",
                                             "0.5",
                                             "1e-300",
                                             "1e308",
                                             "-1e308",
                                             "18446744073709551615",
                                             "-9223372036854775808",
                                             "[]",
                                             "{}",
                                             "[1,2,3]",
                                             "[0,0,0]",
                                             "[1e308,1e308,1e308]",
                                             "[[1,2,3]]",
                                             R"("")",
                                             R"("block")",
                                             R"("hammer")",
                                             R"("cube.off")",
                                             R"("a\u0000b")",
                                             R"({"low":[0,0,0],"high":[1,1,1]})",
                                             R"([{"name":"x"}])"};

TEST_F(SceneMutation, MutatedValuesAreReadOrRejected)
{
    const std::array<json, 2> scenes = {json::parse(fullScene()), json::parse(otherScene())};
    std::array<std::vector<std::string>, 2> places;
    for (int s = 0; s < 2; ++s)
    {
        const json flat = scenes[s].flatten();
        for (const auto& [place, value] : flat.items())
            for (std::string at = place; !at.empty(); at.erase(at.rfind('/'))) places[s].push_back(at);
    }
    int read = 0;
    for (int run = 0; run < 10000; ++run)
    {
        const int s = run % 2;
        json scene = scenes[s];
        for (int k = below(2); k >= 0; --k)
        {
            const json::json_pointer at(places[s][below(places[s].size())]);
            if (!scene.contains(at)) continue;
            json& parent = scene[at.parent_pointer()];
            if (below(4) > 0)
                scene[at] = json::parse(kValues[below(kValues.size())]);
            else if (parent.is_array())
                parent.erase(std::stoul(at.back()));
            else
                parent.erase(at.back());
        }
        read += isScene(scene.dump());
    }
    EXPECT_GT(read, 500);
    EXPECT_LT(read, 9000);
}

}  // namespace
}  // namespace bullet_fem

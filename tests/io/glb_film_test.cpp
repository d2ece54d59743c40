// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// Films are read back by a JSON library and code of this test; validate_glb.sh runs the Khronos validator.
#include "bullet_fem/io/glb_film.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <nlohmann/json.hpp>

#include "bullet_fem/io/colour_map.h"
#include "io/sample_bodies.h"
#include "io/temporary_folder.h"

namespace bullet_fem
{
namespace
{

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;

/// A parsed .glb file.
struct Glb
{
    explicit Glb(const std::string& bytes) : m_size(bytes.size())
    {
        EXPECT_EQ(bytes.substr(0, 4), "glTF");
        EXPECT_EQ(word(bytes, 4), 2u);
        EXPECT_EQ(word(bytes, 8), bytes.size());
        const std::uint32_t json = word(bytes, 12), binary = word(bytes, 20 + json);
        EXPECT_EQ(json % 4, 0u);
        EXPECT_EQ(binary % 4, 0u);
        EXPECT_EQ(28 + json + binary, bytes.size());
        m_json = nlohmann::json::parse(bytes.substr(20, json));
        m_binary = bytes.substr(28 + json);
    }

    static std::uint32_t word(const std::string& bytes, std::size_t at)
    {
        std::uint32_t value = 0;
        std::memcpy(&value, bytes.data() + at, 4);
        return value;
    }

    /// The floats of an accessor; its bounds, if given, must match them.
    std::vector<float> floats(int index) const
    {
        const nlohmann::json& accessor = m_json["accessors"][index];
        const nlohmann::json& view = m_json["bufferViews"][accessor["bufferView"].get<int>()];
        const std::size_t components = accessor["type"] == "VEC3" ? 3 : 1;
        const std::size_t offset = view.value("byteOffset", 0) + accessor.value("byteOffset", 0);
        EXPECT_EQ(accessor["componentType"], 5126);
        EXPECT_EQ(offset % 4, 0u);
        EXPECT_EQ(view.value("byteStride", 12), 12);
        std::vector<float> values(components * accessor["count"].get<std::size_t>());
        EXPECT_LE(accessor.value("byteOffset", 0) + 4 * values.size(), view["byteLength"].get<std::size_t>());
        std::memcpy(values.data(), m_binary.data() + offset, 4 * values.size());
        for (std::size_t c = 0; accessor.contains("min") && c < components; ++c)
        {
            float least = values[c], most = values[c];
            for (std::size_t i = c; i < values.size(); i += components)
            {
                least = std::min(least, values[i]);
                most = std::max(most, values[i]);
            }
            EXPECT_EQ(accessor["min"][c].get<float>(), least);
            EXPECT_EQ(accessor["max"][c].get<float>(), most);
        }
        return values;
    }

    const nlohmann::json& surface(int body) const { return m_json["meshes"][body]["primitives"][0]; }
    std::vector<float> base(int body, const char* name) const { return floats(surface(body)["attributes"][name]); }
    /// Base plus morph target of a frame >= 1, as a viewer displays it.
    std::vector<float> shown(int body, int frame, const char* name) const
    {
        std::vector<float> values = base(body, name);
        const std::vector<float> target = floats(surface(body)["targets"][frame - 1][name]);
        for (std::size_t i = 0; i < values.size(); ++i) values[i] += target.at(i);
        return values;
    }

    std::size_t m_size;
    nlohmann::json m_json;
    std::string m_binary;
};

/// Three frames of two boxes, the first of which moves upwards.
GlbFilm sampleFilm(const GlbSettings& settings = {})
{
    GlbFilm film(settings);
    for (int k = 0; k < 3; ++k) film.addFrame(5 + 0.25 * k, {sampleBox(4, 0.5 * k), sampleBox(9)});
    return film;
}

Glb written(const GlbFilm& film)
{
    const TemporaryFolder folder;
    film.write(folder.path("film.glb"));
    EXPECT_THAT(folder.names(), testing::ElementsAre("film.glb"));
    return Glb(folder.read("film.glb"));
}

// 26 of the 27 nodes are on the surface of a box; node 13 is inside.
TEST(GlbFilm, ShowsEveryFrameOfEveryBody)
{
    const Glb glb = written(sampleFilm());
    ASSERT_EQ(glb.m_json["meshes"].size(), 2u);
    ASSERT_EQ(glb.surface(0)["targets"].size(), 2u);
    EXPECT_EQ(glb.m_json["nodes"][1]["name"], "body 9");
    EXPECT_EQ(glb.m_json["accessors"][glb.surface(0)["indices"].get<int>()]["count"], 3 * 48);
    for (int frame = 0; frame < 3; ++frame)
    {
        const std::vector<Vec3> x = sampleBox(4, 0.5 * frame).m_positions;
        const std::vector<float> found = frame == 0 ? glb.base(0, "POSITION") : glb.shown(0, frame, "POSITION");
        ASSERT_EQ(found.size(), 3u * 26);
        for (int v = 0; v < 26; ++v)
            for (int i = 0; i < 3; ++i) EXPECT_NEAR(found[3 * v + i], x[v < 13 ? v : v + 1][i], 1e-6) << frame;
    }
    EXPECT_EQ(glb.shown(1, 2, "POSITION"), glb.base(1, "POSITION"));
}

TEST(GlbFilm, WeightsPickTheFrameAtItsTime)
{
    const Glb glb = written(sampleFilm());
    const nlohmann::json& animation = glb.m_json["animations"][0];
    const nlohmann::json& sampler = animation["samplers"][0];
    EXPECT_EQ(sampler["interpolation"], "LINEAR");
    EXPECT_THAT(glb.floats(sampler["input"]), ElementsAre(0, 0.25f, 0.5f));
    EXPECT_THAT(glb.floats(sampler["output"]), ElementsAre(0, 0, 1, 0, 0, 1));
    ASSERT_EQ(animation["channels"].size(), 2u);
    EXPECT_EQ(animation["channels"][1]["target"]["node"], 1);
    EXPECT_EQ(animation["channels"][1]["target"]["path"], "weights");
    GlbSettings stepped;
    stepped.m_stepped = true;
    EXPECT_EQ(written(sampleFilm(stepped)).m_json["animations"][0]["samplers"][0]["interpolation"], "STEP");
}

TEST(GlbFilm, NormalsAreOfUnitLengthAndPointOutward)
{
    const Glb glb = written(sampleFilm());
    for (const int frame : {0, 2})
    {
        const std::vector<float> n = frame == 0 ? glb.base(0, "NORMAL") : glb.shown(0, frame, "NORMAL");
        const std::vector<float> x = frame == 0 ? glb.base(0, "POSITION") : glb.shown(0, frame, "POSITION");
        const Vec3 centre = {8.5 + 0.25 * 0.5 * frame * 8.5, 0.5, 0.5 + 0.5 * frame};
        for (int v = 0; v < 26; ++v)
        {
            const Vec3 normal = {n[3 * v], n[3 * v + 1], n[3 * v + 2]};
            EXPECT_NEAR(norm(normal), 1, 1e-6);
            EXPECT_GT(dot(normal, Vec3{x[3 * v], x[3 * v + 1], x[3 * v + 2]} - centre), 0.3);
        }
    }
    GlbSettings flat;
    flat.m_normals = false;
    EXPECT_FALSE(written(sampleFilm(flat)).surface(0)["attributes"].contains("NORMAL"));
}

// Vertex 25 is node 26, because node 13 is inside.
TEST(GlbFilm, ColoursAreThoseOfTheStressOrOfItsPeak)
{
    GlbSettings settings;
    settings.m_colours = GlbColours::vonMises;
    settings.m_hottest = 40e3;
    const auto colour = [&](int frame)
    { return linearColour(viridis(vonMises(sampleBox(4, 0.5 * frame).m_nodeStress[26]) / 40e3)); };
    const Glb moving = written(sampleFilm(settings));
    const std::vector<float> first = moving.base(0, "COLOR_0"), last = moving.shown(0, 2, "COLOR_0");
    for (int i = 0; i < 3; ++i)
    {
        EXPECT_NEAR(first[3 * 25 + i], colour(0)[i], 1e-6);
        EXPECT_NEAR(last[3 * 25 + i], colour(2)[i], 1e-6);
    }
    settings.m_colours = GlbColours::peakVonMises;
    const Glb peak = written(sampleFilm(settings));
    EXPECT_FALSE(peak.surface(0)["targets"][0].contains("COLOR_0"));
    for (int i = 0; i < 3; ++i) EXPECT_NEAR(peak.base(0, "COLOR_0")[3 * 25 + i], colour(2)[i], 1e-6);

    settings.m_hottest = 0;
    const GlbFilm film = sampleFilm(settings);
    EXPECT_NEAR(film.highestVonMises(), vonMises(sampleBox(9).m_nodeStress[26]), 1e-2);
    EXPECT_NEAR(written(film).m_json["asset"]["extras"]["hottest_von_mises_pa"].get<double>(), film.highestVonMises(),
                1e-9);
}

// Quaternions of glTF are (x, y, z, w): q turns (0, 0, 1) to (2 x z + 2 w y, 2 y z - 2 w x, ...).
TEST(GlbFilm, RotatesAZUpWorld)
{
    EXPECT_FALSE(written(sampleFilm()).m_json["nodes"][1].contains("rotation"));
    GlbSettings settings;
    settings.m_zUp = true;
    const std::vector<double> q = written(sampleFilm(settings)).m_json["nodes"][1]["rotation"];
    EXPECT_NEAR(2 * q[1] * q[2] - 2 * q[3] * q[0], 1, 1e-9);
}

TEST(GlbFilm, OneFrameIsAStill)
{
    GlbFilm film;
    film.addFrame(3, {sampleBox(0)});
    const Glb glb = written(film);
    EXPECT_FALSE(glb.m_json.contains("animations"));
    EXPECT_FALSE(glb.surface(0).contains("targets"));
}

TEST(GlbFilm, SizesArePredicted)
{
    for (const GlbColours colours : {GlbColours::plain, GlbColours::vonMises, GlbColours::peakVonMises})
        for (const bool normals : {false, true})
        {
            GlbSettings settings;
            settings.m_colours = colours;
            settings.m_normals = normals;
            const GlbFilm film = sampleFilm(settings);
            EXPECT_GE(film.byteCount(), written(film).m_size);
        }
    EXPECT_EQ(GlbFilm().byteCount(), 0u);
}

TEST(GlbFilmInput, RejectsFramesBeyondLimitsKeepingEarlierOnes)
{
    GlbSettings settings;
    settings.m_maxFrames = 3;
    GlbFilm film = sampleFilm(settings);
    const auto add = [&film] { film.addFrame(9, {sampleBox(4), sampleBox(9)}); };
    EXPECT_THAT(messageOf<std::invalid_argument>(add), HasSubstr("this would be frame 4 of 3 at most; take fewer"));
    EXPECT_EQ(film.frameCount(), 3);
    settings.m_maxFrames = 256;
    settings.m_maxBytes = film.byteCount() + 10;
    film = sampleFilm(settings);
    EXPECT_THAT(messageOf<std::invalid_argument>(add),
                AllOf(HasSubstr("bytes of " + std::to_string(settings.m_maxBytes)), HasSubstr("m_maxBytes")));
    EXPECT_EQ(written(film).surface(0)["targets"].size(), 2u);
}

TEST(GlbFilmInput, RejectsInconsistentFrames)
{
    GlbFilm film = sampleFilm();
    const auto rejected = [&film](double time, const std::vector<BodyFrame>& bodies)
    { return messageOf<std::invalid_argument>([&] { film.addFrame(time, bodies); }); };
    EXPECT_THAT(rejected(5.5, {sampleBox(4), sampleBox(9)}),
                HasSubstr("it must be later than the last frame's, 5.5 s"));
    EXPECT_THAT(rejected(NAN, {sampleBox(4), sampleBox(9)}), HasSubstr("time is nan"));
    EXPECT_THAT(rejected(9, {}), HasSubstr("one body at least"));
    EXPECT_THAT(rejected(9, {sampleBox(4)}), HasSubstr("not those of the first frame"));
    EXPECT_THAT(rejected(9, {sampleBox(4), sampleBox(8)}), HasSubstr("not those of the first frame"));
    EXPECT_THAT(rejected(9, {sampleBox(4), sampleTriangle(9)}), HasSubstr("not those of the first frame"));
    BodyFrame wrong = sampleBox(9);
    wrong.m_positions[3].x = NAN;
    EXPECT_THAT(rejected(9, {sampleBox(4), wrong}), HasSubstr("position of vertex 3"));
    EXPECT_EQ(film.frameCount(), 3);

    GlbFilm empty;
    wrong = sampleBox(9);
    wrong.m_triangles.clear();
    EXPECT_THAT(messageOf<std::invalid_argument>([&] { empty.addFrame(0, {wrong}); }),
                HasSubstr("body 9 has no triangle"));
    EXPECT_THAT(messageOf<std::invalid_argument>([&] { empty.write("film.glb"); }), HasSubstr("no frame"));
    GlbSettings coloured;
    coloured.m_colours = GlbColours::vonMises;
    GlbFilm cold(coloured);
    EXPECT_THAT(messageOf<std::invalid_argument>([&] { cold.addFrame(0, {sampleTriangle(7)}); }),
                HasSubstr("body 7 has no node stress"));
}

TEST(GlbFilmInput, RejectsSettingsOutOfRange)
{
    GlbSettings settings;
    settings.m_hottest = -1;
    EXPECT_THAT(messageOf<std::invalid_argument>([&] { GlbFilm film(settings); }), HasSubstr("m_hottest is -1 Pa"));
    settings = {};
    settings.m_maxFrames = 0;
    EXPECT_THAT(messageOf<std::invalid_argument>([&] { GlbFilm film(settings); }), HasSubstr("m_maxFrames is 0"));
    settings = {};
    settings.m_maxBytes = std::size_t(1) << 32;
    EXPECT_THAT(messageOf<std::invalid_argument>([&] { GlbFilm film(settings); }), HasSubstr("[1, 4294967295]"));
}

TEST(GlbFilmInput, RejectsUnwritablePaths)
{
    const TemporaryFolder folder;
    const GlbFilm film = sampleFilm();
    EXPECT_THAT(messageOf<std::runtime_error>([&] { film.write(folder.path("missing/film.glb")); }),
                HasSubstr("missing/film.glb'"));
    EXPECT_THAT(messageOf<std::runtime_error>([&] { film.write("/dev/full"); }), HasSubstr("No space left"));
}

}  // namespace
}  // namespace bullet_fem

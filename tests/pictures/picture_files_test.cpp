// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <stb_image.h>
#include <stdlib.h>
#include <sys/stat.h>

#include <cstdio>
#include <filesystem>

#include "io/temporary_folder.h"
#include "tools/pictures/film_writer.h"
#include "tools/pictures/image.h"

namespace bullet_fem
{
namespace
{

using testing::AllOf;
using testing::HasSubstr;
using testing::IsEmpty;

/// Red grows to the right, green downwards, blue with `t`.
Image gradient(const PictureSize& size, int t = 0)
{
    Image image(size);
    for (int y = 0; y < size.m_height; ++y)
        for (int x = 0; x < size.m_width; ++x)
        {
            unsigned char* p = &image.m_pixels[3 * (static_cast<std::size_t>(y) * size.m_width + x)];
            p[0] = static_cast<unsigned char>(255 * x / size.m_width);
            p[1] = static_cast<unsigned char>(255 * y / size.m_height);
            p[2] = static_cast<unsigned char>(20 * t);
        }
    return image;
}

TEST(Png, HoldsThePixels)
{
    const TemporaryFolder folder;
    const Image image = gradient({37, 21});
    writePng(image, folder.path("a.png"));
    int width = 0, height = 0, parts = 0;
    unsigned char* pixels = stbi_load(folder.path("a.png").c_str(), &width, &height, &parts, 3);
    ASSERT_NE(pixels, nullptr);
    EXPECT_EQ(width, 37);
    EXPECT_EQ(height, 21);
    EXPECT_TRUE(std::equal(image.m_pixels.begin(), image.m_pixels.end(), pixels));
    stbi_image_free(pixels);
    writePng(image, folder.path("b.png"));
    EXPECT_EQ(folder.read("a.png"), folder.read("b.png"));
    EXPECT_EQ(folder.names().size(), 2u);
}

TEST(Png, UnwritablePathsAreNamedAndLeaveNothing)
{
    const TemporaryFolder folder;
    const Image image = gradient({4, 4});
    const std::string missing = folder.path("missing/a.png");
    EXPECT_THAT(messageOf<std::runtime_error>([&] { writePng(image, missing); }),
                HasSubstr("cannot write '" + missing));
    std::filesystem::create_directory(folder.path("folder.png"));
    EXPECT_THAT(messageOf<std::runtime_error>([&] { writePng(image, folder.path("folder.png")); }),
                HasSubstr("it is a directory"));
    EXPECT_THAT(messageOf<std::invalid_argument>([&] { writePng(Image(), folder.path("a.png")); }), HasSubstr("0 x 0"));
    Image broken = image;
    broken.m_pixels.pop_back();
    EXPECT_THAT(messageOf<std::invalid_argument>([&] { writePng(broken, folder.path("a.png")); }),
                HasSubstr("47 bytes"));
    EXPECT_THAT(folder.names(), testing::ElementsAre("folder.png"));
}

TEST(Strip, PutsImagesBesideEachOther)
{
    const Image a = gradient({5, 4}), b = gradient({3, 4}, 5);
    const Image strip = besideEachOther({a, b}, 2);
    EXPECT_EQ(strip.m_size.m_width, 10);
    EXPECT_EQ(strip.at(4, 3), a.at(4, 3));
    EXPECT_EQ(strip.at(5, 1), (std::array<int, 3>{255, 255, 255}));
    EXPECT_EQ(strip.at(7, 0), b.at(0, 0));
    EXPECT_EQ(strip.at(9, 3), b.at(2, 3));
    EXPECT_THAT(messageOf<std::invalid_argument>(
                    [&] {
                        besideEachOther({a, gradient({5, 3})}, 2);
                    }),
                HasSubstr("4 and 3"));
    EXPECT_THAT(messageOf<std::invalid_argument>([&] { besideEachOther({}, 2); }), HasSubstr("at least one"));
}

void writeFilm(const std::string& path, const PictureSize& size)
{
    FilmWriter film(path, size, 25);
    for (int t = 0; t < 7; ++t) film.append(gradient(size, t));
    film.finish();
}

/// The standard output of a command.
std::string printed(const std::string& command)
{
    std::string text;
    std::FILE* pipe = popen(command.c_str(), "r");
    for (int c; pipe && (c = std::fgetc(pipe)) != EOF;) text += static_cast<char>(c);
    if (pipe) pclose(pipe);
    return text;
}

TEST(Film, GifHasAllFrames)
{
    if (!FilmWriter::available()) GTEST_SKIP() << "ffmpeg is not in PATH";
    const TemporaryFolder folder;
    writeFilm(folder.path("a.gif"), {40, 30});
    const std::string bytes = folder.read("a.gif");
    int width = 0, height = 0, frames = 0, parts = 0, *delays = nullptr;
    unsigned char* pixels =
        stbi_load_gif_from_memory(reinterpret_cast<const unsigned char*>(bytes.data()), static_cast<int>(bytes.size()),
                                  &delays, &width, &height, &frames, &parts, 3);
    ASSERT_NE(pixels, nullptr);
    EXPECT_EQ(width, 40);
    EXPECT_EQ(height, 30);
    EXPECT_EQ(frames, 7);
    EXPECT_EQ(delays[0], 40) << "milliseconds";
    stbi_image_free(pixels);
    stbi_image_free(delays);
    writeFilm(folder.path("b.gif"), {40, 30});
    EXPECT_EQ(bytes, folder.read("b.gif"));
    EXPECT_EQ(folder.names().size(), 2u);
}

TEST(Film, Mp4HasAllFramesAndAnEvenSize)
{
    if (!FilmWriter::available()) GTEST_SKIP() << "ffmpeg is not in PATH";
    const TemporaryFolder folder;
    writeFilm(folder.path("a.mp4"), {41, 31});
    EXPECT_EQ(printed("ffprobe -v error -count_frames -show_entries stream=width,height,nb_read_frames -of csv=p=0 " +
                      folder.path("a.mp4")),
              "42,32,7\n");
    writeFilm(folder.path("b.mp4"), {41, 31});
    EXPECT_EQ(folder.read("a.mp4"), folder.read("b.mp4"));
}

TEST(Film, AbandonedFilmsLeaveNothing)
{
    if (!FilmWriter::available()) GTEST_SKIP() << "ffmpeg is not in PATH";
    const TemporaryFolder folder;
    folder.write("a.mp4", "the old one");
    {
        FilmWriter film(folder.path("a.mp4"), {40, 30}, 25);
        film.append(gradient({40, 30}));
        EXPECT_THAT(messageOf<std::invalid_argument>([&] { film.append(gradient({30, 40})); }), HasSubstr("40 x 30"));
    }
    EXPECT_EQ(folder.read("a.mp4"), "the old one");
    EXPECT_EQ(folder.names().size(), 1u);
    FilmWriter empty(folder.path("b.mp4"), {40, 30}, 25);
    EXPECT_THAT(messageOf<std::invalid_argument>([&] { empty.finish(); }), HasSubstr("no frames"));
}

TEST(Film, RejectsInvalidFilms)
{
    const TemporaryFolder folder;
    const auto start = [&](const char* name, const PictureSize& size, int rate)
    { return messageOf<std::invalid_argument>([&] { FilmWriter film(folder.path(name), size, rate); }); };
    EXPECT_THAT(start("a.avi", {40, 30}, 25), AllOf(HasSubstr("a.avi"), HasSubstr(".mp4 or .gif")));
    EXPECT_THAT(start("a.mp4", {40, 30}, 0), HasSubstr("rate is 0"));
    EXPECT_THAT(start("a.mp4", {0, 30}, 25), HasSubstr("0 x 30"));
    const std::string missing = folder.path("missing/a.gif");
    EXPECT_THAT(messageOf<std::runtime_error>([&] { FilmWriter film(missing, {40, 30}, 25); }), HasSubstr(missing));
    EXPECT_THAT(folder.names(), IsEmpty());
}

/// Replaces ffmpeg by a program of the test, or by none.
class FilmWithoutFfmpeg : public testing::Test
{
protected:
    void SetUp() override { setenv("PATH", m_folder.path("bin").c_str(), 1); }
    void TearDown() override { setenv("PATH", m_path.c_str(), 1); }
    void putProgram(const std::string& script)
    {
        std::filesystem::create_directory(m_folder.path("bin"));
        chmod(m_folder.write("bin/ffmpeg", "#!/bin/sh\n" + script).c_str(), 0755);
    }

    const TemporaryFolder m_folder;
    const std::string m_path = getenv("PATH");
};

TEST_F(FilmWithoutFfmpeg, ReportsThatFfmpegIsMissing)
{
    EXPECT_FALSE(FilmWriter::available());
    EXPECT_THAT(messageOf<std::runtime_error>(
                    [&] {
                        writeFilm(m_folder.path("a.mp4"), {40, 30});
                    }),
                AllOf(HasSubstr("a.mp4"), HasSubstr("ffmpeg cannot be started"), HasSubstr("install it")));
    EXPECT_THAT(m_folder.names(), IsEmpty());
}

TEST_F(FilmWithoutFfmpeg, ReportsTheErrorsOfAFailingFfmpeg)
{
    putProgram("echo the disk is full >&2\nexit 1\n");
    EXPECT_TRUE(FilmWriter::available());
    EXPECT_THAT(messageOf<std::runtime_error>(
                    [&] {
                        writeFilm(m_folder.path("a.mp4"), {400, 300});
                    }),
                HasSubstr("the disk is full"));
    putProgram("while read -r line; do :; done\necho late failure >&2\nexit 1\n");
    EXPECT_THAT(messageOf<std::runtime_error>(
                    [&] {
                        writeFilm(m_folder.path("a.mp4"), {40, 30});
                    }),
                HasSubstr("late failure"));
    EXPECT_THAT(m_folder.names(), testing::ElementsAre("bin"));
}

}  // namespace
}  // namespace bullet_fem

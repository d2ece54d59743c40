// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "tools/pictures/film_recorder.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <stdio.h>
#include <stdlib.h>

#include <chrono>
#include <thread>

#include "io/temporary_folder.h"

namespace bullet_fem
{
namespace
{

using testing::HasSubstr;

Image plainImage(const PictureSize& size)
{
    Image image;
    image.m_size = size;
    image.m_pixels.assign(static_cast<std::size_t>(3 * size.m_width * size.m_height), 90);
    return image;
}

void finish(FilmRecorder& film)
{
    for (film.stop(); film.message().find("Finishing") == 0; film.update())
        std::this_thread::sleep_for(std::chrono::milliseconds(5));
}

int framesIn(const std::string& path)
{
    FILE* pipe = popen(
        ("ffprobe -v error -count_frames -show_entries stream=nb_read_frames -of csv=p=0 '" + path + "'").c_str(), "r");
    int frames = -1;
    if (pipe && fscanf(pipe, "%d", &frames) != 1) frames = -1;
    if (pipe) pclose(pipe);
    return frames;
}

class FilmRecorderTest : public testing::Test
{
protected:
    void SetUp() override
    {
        if (!FilmWriter::available()) GTEST_SKIP() << "ffmpeg is not in PATH";
    }
    const PictureSize m_size{64, 48};
    const TemporaryFolder m_folder;
    FilmRecorder m_film{m_folder.path("films")};
};

// One frame for each thirtieth of a second of simulated time, for any steps, and none in a pause.
TEST_F(FilmRecorderTest, FilmsTheSimulationsTime)
{
    EXPECT_FALSE(m_film.recording());
    EXPECT_EQ(m_film.due(), 0);
    ASSERT_TRUE(m_film.start(m_size)) << m_film.message();
    EXPECT_TRUE(m_film.recording());
    EXPECT_EQ(m_film.due(), 1) << "the start";
    m_film.append(plainImage(m_size));
    EXPECT_EQ(m_film.due(), 0);
    for (int k = 0; k < 60; ++k)  // half a second
    {
        m_film.advance(1. / 120);
        if (m_film.due() > 0) m_film.append(plainImage(m_size));
    }
    m_film.advance(0.1);
    EXPECT_EQ(m_film.due(), 3);
    m_film.append(plainImage(m_size));
    for (int k = 0; k < 10; ++k) m_film.advance(0);
    EXPECT_EQ(m_film.due(), 0);
    finish(m_film);
    EXPECT_FALSE(m_film.recording());
    EXPECT_EQ(m_film.path(), m_folder.path("films/film_001.mp4"));
    EXPECT_EQ(m_film.message(), m_film.path() + ": 19 frames");
    EXPECT_EQ(framesIn(m_film.path()), 19);
}

TEST_F(FilmRecorderTest, NoFilmTakesTheNameOfAnother)
{
    for (const char* name : {"films/film_001.mp4", "films/film_002.mp4"})
    {
        ASSERT_TRUE(m_film.start(m_size));
        m_film.append(plainImage(m_size));
        finish(m_film);
        EXPECT_EQ(m_film.path(), m_folder.path(name));
        EXPECT_EQ(framesIn(m_folder.path(name)), 1);
    }
}

TEST_F(FilmRecorderTest, StopsIfTheWindowIsResized)
{
    ASSERT_TRUE(m_film.start(m_size));
    m_film.append(plainImage(m_size));
    m_film.advance(1);
    m_film.append(plainImage({80, 48}));
    EXPECT_FALSE(m_film.recording());
    finish(m_film);
    EXPECT_EQ(framesIn(m_film.path()), 1);
}

TEST_F(FilmRecorderTest, ReportsFailuresInASentence)
{
    m_folder.write("file", "no folder");
    FilmRecorder nowhere(m_folder.path("file/films"));
    EXPECT_FALSE(nowhere.start(m_size));
    EXPECT_FALSE(nowhere.recording());
    EXPECT_THAT(nowhere.message(), testing::AllOf(HasSubstr("No film: "), HasSubstr("file/films")));
    ASSERT_TRUE(m_film.start(m_size));
    finish(m_film);
    EXPECT_THAT(m_film.message(), HasSubstr("No film: ")) << "without a frame";

    const std::string path = getenv("PATH");
    setenv("PATH", m_folder.path("").c_str(), 1);
    EXPECT_FALSE(m_film.start(m_size));
    EXPECT_THAT(m_film.message(), HasSubstr("ffmpeg"));
    setenv("PATH", path.c_str(), 1);
}

}  // namespace
}  // namespace bullet_fem

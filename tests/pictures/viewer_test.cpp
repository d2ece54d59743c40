// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// The viewer's events and panels. Needs a display: use xvfb-run if there is none.
#include "tools/pictures/viewer.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <stdlib.h>

#include <chrono>
#include <cmath>
#include <filesystem>
#include <memory>
#include <thread>
#include <vector>

#include "io/temporary_folder.h"
#include "pictures/ball_simulation.h"
#include "tools/pictures/film_writer.h"
#include "tools/pictures/legend.h"

namespace bullet_fem
{
namespace
{

class ViewerTest : public testing::Test
{
protected:
    void SetUp() override
    {
        if (!getenv("DISPLAY")) GTEST_SKIP() << "there is no display, and no xvfb-run";
        ViewerSettings settings;
        settings.m_size = {800, 600};
        settings.m_filmFolder = m_folder.path("films");
        m_viewer = std::make_unique<Viewer>(m_simulation, settings);
        m_viewer->frame(0);
    }

    /// Sends each event in a frame of its own.
    void play(const std::vector<ViewerEvent>& events)
    {
        for (const ViewerEvent& event : events)
        {
            m_viewer->inject(event);
            EXPECT_TRUE(m_viewer->frame());
        }
    }
    ViewerEvent moveTo(const Vec3& point) const
    {
        const PicturePoint p = projected(m_viewer->control().camera(), m_viewer->size(), point);
        return ViewerEvent::move(p.m_x, p.m_y);
    }
    ViewerEvent moveToSlider(std::size_t index, double share) const
    {
        const PictureRectangle area = m_viewer->sliderArea(index);
        return ViewerEvent::move(area.m_x + share * area.m_width, area.m_y + 0.5 * area.m_height);
    }

    const TemporaryFolder m_folder;
    BallSimulation m_simulation;
    std::unique_ptr<Viewer> m_viewer;
};

TEST_F(ViewerTest, DrawsBetweenStepsUnlessItIsPaused)
{
    m_viewer->frame(1, -0.25);
    EXPECT_EQ(m_simulation.m_drawnTime, -0.25);
    m_viewer->inject(ViewerEvent::key(ViewerKey::pause));
    m_viewer->frame(1, -0.25);
    EXPECT_EQ(m_simulation.m_drawnTime, 0);
}

TEST_F(ViewerTest, AScriptedDragMovesTheBallInThePictureToo)
{
    const Vec3 from{0.4, 0.5, 0}, to{0.9, 0.2, 0};
    const PictureCamera camera = m_viewer->control().camera();
    const Image before = m_viewer->screenshot();
    play({moveTo(from), ViewerEvent::press(), moveTo({0.7, 0.3, 0}), moveTo(to), ViewerEvent::release()});
    EXPECT_NEAR(norm(m_simulation.m_centre - to), 0, 1e-9);
    EXPECT_FALSE(m_simulation.m_held);
    EXPECT_EQ(m_simulation.m_steps, 5);
    const Image after = m_viewer->screenshot();
    ASSERT_EQ(after.m_size.m_width, 800);
    const auto isBall = [&](const Image& image, const Vec3& x)  // orange on a blue and white background
    {
        const std::array<int, 3> p = pixelAt(image, camera, x);
        return p[0] > 1.4 * p[2];
    };
    EXPECT_TRUE(isBall(before, from) && !isBall(before, to));
    EXPECT_TRUE(isBall(after, to) && !isBall(after, from));
}

TEST_F(ViewerTest, SlidersSetParametersAndKeepTheCameraStill)
{
    const PictureCamera camera = m_viewer->control().camera();
    play({moveToSlider(1, 0.5), ViewerEvent::press(), moveToSlider(1, 0.9), ViewerEvent::release()});
    EXPECT_NEAR(m_simulation.m_values[1], 0.9 * 0.49, 0.03);
    EXPECT_EQ(m_simulation.m_values[0], 1e6);
    play({moveToSlider(0, 0.25), ViewerEvent::press(), ViewerEvent::release()});
    EXPECT_NEAR(std::log10(m_simulation.m_values[0]), 5, 0.2) << "a quarter of the way from 1e4 to 1e8";
    EXPECT_EQ(norm(m_viewer->control().camera().m_eye - camera.m_eye), 0);
    m_simulation.m_refusal = "E must be smaller";
    EXPECT_NO_THROW(play({moveToSlider(0, 0.75), ViewerEvent::press(), ViewerEvent::release()}));
    EXPECT_NEAR(std::log10(m_simulation.m_values[0]), 5, 0.2) << "refused";
}

TEST_F(ViewerTest, PausesStepsHidesItsPanelAndCloses)
{
    play({ViewerEvent::key(ViewerKey::pause)});
    m_viewer->frame(5);
    EXPECT_EQ(m_simulation.m_steps, 0);
    play({ViewerEvent::key(ViewerKey::step)});
    EXPECT_EQ(m_simulation.m_steps, 1);
    EXPECT_GT(m_viewer->sliderArea(0).m_width, 100);
    const Image panel = m_viewer->screenshot();
    play({ViewerEvent::key(ViewerKey::panel)});
    EXPECT_EQ(m_viewer->sliderArea(0).m_width, 0);
    const Image bare = m_viewer->screenshot();
    int different = 0;
    for (std::size_t i = 0; i < bare.m_pixels.size(); i += 3) different += bare.m_pixels[i] != panel.m_pixels[i];
    EXPECT_GT(different, 10000) << "of the panel's some 80,000 pixels";
    m_viewer->inject(ViewerEvent::key(ViewerKey::close));
    EXPECT_FALSE(m_viewer->frame());
}

TEST_F(ViewerTest, UndrawableScenePausesIt)
{
    m_simulation.place({std::nan(""), 0, 0});
    EXPECT_TRUE(m_viewer->frame());
    EXPECT_TRUE(m_viewer->control().paused());
    const Image before = m_viewer->screenshot();
    EXPECT_TRUE(m_viewer->frame()) << "with the reason in the panel now";
    EXPECT_NE(m_viewer->screenshot().m_pixels, before.m_pixels);
    m_simulation.place({0, 0.5, 0});
    play({ViewerEvent::key(ViewerKey::pause)});
    EXPECT_FALSE(m_viewer->control().paused());
}

int pixelsApart(const Image& a, const Image& b)
{
    int different = 0;
    for (std::size_t i = 0; i < a.m_pixels.size(); i += 3) different += a.m_pixels[i] != b.m_pixels[i];
    return different;
}

TEST_F(ViewerTest, HelpProgressAndSentencesStandOverThePicture)
{
    play({ViewerEvent::key(ViewerKey::pause), ViewerEvent::key(ViewerKey::panel)});
    m_viewer->frame();
    const Image bare = m_viewer->screenshot();
    play({ViewerEvent::key(ViewerKey::help)});
    m_viewer->frame();
    EXPECT_GT(pixelsApart(bare, m_viewer->screenshot()), 100000) << "of the help's some 250,000 pixels";
    play({ViewerEvent::key(ViewerKey::help)});
    m_simulation.m_progress = {"ball.off: making the cage", 0.4};
    m_viewer->frame();
    m_viewer->frame();
    const Image busy = m_viewer->screenshot();
    EXPECT_GT(pixelsApart(bare, busy), 10000);
    m_simulation.m_progress.m_share = 0.8;
    m_viewer->frame();
    EXPECT_GT(pixelsApart(busy, m_viewer->screenshot()), 1000) << "the bar grows";
    m_simulation.m_progress = {};
    m_simulation.m_message = std::string(4000, 'x') + " \xc3";
    m_viewer->frame();
    m_viewer->frame();
    EXPECT_GT(pixelsApart(bare, m_viewer->screenshot()), 10000);
    m_simulation.m_message.clear();
    m_viewer->frame();
    EXPECT_EQ(m_viewer->screenshot().m_pixels, bare.m_pixels);
    EXPECT_GT(m_simulation.m_updates, 8) << "in every frame, also in a pause";
}

TEST_F(ViewerTest, ButtonSendsTheCancelKey)
{
    play({ViewerEvent::key(ViewerKey::panel)});
    m_simulation.m_progress = {"ball.off: making the cage", 0.4};
    m_viewer->frame();
    // Above the caption, to the right of the bar.
    play({ViewerEvent::move(400 + 180, 600 - captionHeight({800, 600}) - 22), ViewerEvent::press(),
          ViewerEvent::release()});
    EXPECT_THAT(m_simulation.m_keys, testing::ElementsAre(ViewerKey::cancel));
}

TEST_F(ViewerTest, ADropIsOpenedAndAFilmIsMade)
{
    if (!FilmWriter::available()) GTEST_SKIP() << "ffmpeg is not in PATH";
    play({ViewerEvent::drop({"a.off"})});
    EXPECT_THAT(m_simulation.m_files, testing::ElementsAre("a.off"));
    play({ViewerEvent::key(ViewerKey::film)});
    EXPECT_TRUE(m_viewer->control().filming());
    for (int k = 0; k < 12; ++k) m_viewer->frame(2);
    play({ViewerEvent::key(ViewerKey::film)});
    EXPECT_FALSE(m_viewer->control().filming());
    const std::string film = m_folder.path("films/film_001.mp4");
    for (int k = 0; k < 500 && !std::filesystem::exists(film); ++k)
    {
        m_viewer->frame();
        std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    EXPECT_GT(std::filesystem::file_size(film), 1000u);
}

TEST_F(ViewerTest, AnOffscreenRendererWorksBesideIt)
{
    OffscreenRenderer renderer;
    const Image first = renderer.render(m_simulation.m_scene, {160, 120});
    m_viewer->frame();
    EXPECT_EQ(renderer.render(m_simulation.m_scene, {160, 120}).m_pixels, first.m_pixels);
    EXPECT_TRUE(m_viewer->frame());
}

}  // namespace
}  // namespace bullet_fem

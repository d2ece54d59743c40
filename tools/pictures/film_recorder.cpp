// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "tools/pictures/film_recorder.h"

#include <chrono>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <utility>

#include "fem/common/message.h"
#include "fem/common/reason.h"

namespace bullet_fem
{
namespace
{

/// The first unused file name.
std::string freeName(const std::string& folder)
{
    for (int n = 1;; ++n)
    {
        char name[32];
        std::snprintf(name, sizeof name, "film_%03d.mp4", n);
        const std::filesystem::path path = std::filesystem::path(folder) / name;
        if (!std::filesystem::exists(path)) return path.string();
    }
}

}  // namespace

bool FilmRecorder::start(const PictureSize& size)
{
    if (m_finishing.valid()) m_finishing.wait();
    update();
    try
    {
        std::filesystem::create_directories(m_folder);
        m_path = freeName(m_folder);
        m_writer = std::make_unique<FilmWriter>(m_path, size, kFramesPerSecond);
    }
    catch (const std::exception& error)
    {
        m_message = "No film: " + reasonOf(error);
        return false;
    }
    m_size = size;
    m_time = 0;
    m_frames = 0;
    m_message.clear();
    return true;
}

int FilmRecorder::due() const
{
    return recording() ? 1 + static_cast<int>(std::floor(m_time * kFramesPerSecond + 1e-6)) - m_frames : 0;
}

void FilmRecorder::append(const Image& image)
{
    if (image.m_size.m_width != m_size.m_width || image.m_size.m_height != m_size.m_height) return stop();
    try
    {
        for (int k = due(); k > 0; --k, ++m_frames) m_writer->append(image);
    }
    catch (const std::exception& error)
    {
        m_writer.reset();
        m_message = "The film ended: " + reasonOf(error);
    }
}

void FilmRecorder::stop()
{
    if (!recording()) return;
    const std::string done = bullet_fem::message(m_path, ": ", m_frames, " frames");
    m_message = "Finishing " + m_path;
    const auto finish = [done, writer = std::shared_ptr<FilmWriter>(std::move(m_writer))]
    {
        try
        {
            writer->finish();
            return done;
        }
        catch (const std::exception& error)
        {
            return "No film: " + reasonOf(error);
        }
    };
    m_finishing = std::async(std::launch::async, finish);
}

void FilmRecorder::update()
{
    if (m_finishing.valid() && m_finishing.wait_for(std::chrono::seconds(0)) == std::future_status::ready)
        m_message = m_finishing.get();
}

}  // namespace bullet_fem

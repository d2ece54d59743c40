// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <future>
#include <memory>
#include <string>
#include <utility>

#include "tools/pictures/film_writer.h"

namespace bullet_fem
{

/// Films of a window's content in simulated time; pauses are not filmed. It does not throw on file errors, but reports
/// them in `message`.
class FilmRecorder
{
public:
    /// Films are called film_001.mp4 and so on in `folder`, which is created for the first one.
    explicit FilmRecorder(std::string folder) : m_folder(std::move(folder)) {}

    /// Returns false if no film can be made.
    bool start(const PictureSize& size);
    bool recording() const { return m_writer != nullptr; }
    /// Adds `seconds`, >= 0, of simulated time.
    void advance(double seconds) { m_time += seconds; }
    /// Number of frames that are due and should be appended.
    int due() const;
    /// Appends the picture for all frames that are due. A change of size ends the film.
    void append(const Image& image);
    /// Ends the film. A background thread finishes the file and gives it its name.
    void stop();
    /// Call in each frame: collects films that the background thread has finished.
    void update();
    /// Result of the last film or an error message; empty at first.
    const std::string& message() const { return m_message; }
    const std::string& path() const { return m_path; }  ///< of the last film

    static constexpr int kFramesPerSecond = 30;

private:
    std::string m_folder, m_path, m_message;
    std::unique_ptr<FilmWriter> m_writer;
    PictureSize m_size;
    double m_time = 0;  // simulated time since the start [s]
    int m_frames = 0;
    std::future<std::string> m_finishing;  // gives the message
};

}  // namespace bullet_fem

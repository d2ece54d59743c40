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

/// Films of what a window shows, in the simulation's time: a pause is not filmed. It never
/// throws because of a file: `message` tells.
class FilmRecorder
{
public:
    /// Films are called film_001.mp4 and so on, in `folder`, which is made when the first one starts.
    explicit FilmRecorder(std::string folder) : m_folder(std::move(folder)) {}

    /// False if there can be no film.
    bool start(const PictureSize& size);
    bool recording() const { return m_writer != nullptr; }
    /// The simulation has gone on by `seconds`, >= 0.
    void advance(double seconds) { m_time += seconds; }
    /// How many frames are missing: what is seen is to be appended then.
    int due() const;
    /// What is seen, for all frames that are due. Where it has another size now, the film ends.
    void append(const Image& image);
    /// Ends the film. The file is finished in the background, and has its name then.
    void stop();
    /// To be called in every frame: takes what the background has finished.
    void update();
    /// A sentence on the film, or what went wrong; empty at first.
    const std::string& message() const { return m_message; }
    const std::string& path() const { return m_path; }  ///< of the last film

    static constexpr int kFramesPerSecond = 30;

private:
    std::string m_folder, m_path, m_message;
    std::unique_ptr<FilmWriter> m_writer;
    PictureSize m_size;
    double m_time = 0;  // since the start [s]
    int m_frames = 0;
    std::future<std::string> m_finishing;  // what to say then
};

}  // namespace bullet_fem

// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <memory>
#include <string>

#include "tools/pictures/image.h"

namespace bullet_fem
{

/// Writes frames as a film by the program `ffmpeg` in PATH, which is not linked. The file gets its name in `finish`; a
/// writer destroyed earlier leaves no file.
class FilmWriter
{
public:
    /// Starts a film at `path`, ending in .mp4 (H.264) or .gif, with `framesPerSecond` in [1, 100]. Throws
    /// std::invalid_argument on another ending or rate or an empty size, std::runtime_error if ffmpeg is missing or the
    /// path cannot be written.
    FilmWriter(const std::string& path, const PictureSize& size, int framesPerSecond);
    ~FilmWriter();
    FilmWriter(const FilmWriter&) = delete;
    FilmWriter& operator=(const FilmWriter&) = delete;

    /// Throws std::invalid_argument if the frame's size differs from the film's, std::runtime_error with ffmpeg's
    /// message if ffmpeg has ended.
    void append(const Image& frame);
    /// Waits for ffmpeg and names the file; no more frames can be appended. Throws std::invalid_argument without
    /// frames, std::runtime_error with ffmpeg's message if it failed.
    void finish();

    /// Whether ffmpeg is in PATH.
    static bool available();

private:
    struct Child;
    std::unique_ptr<Child> m_child;
    PictureSize m_size;
    int m_frames = 0;
};

}  // namespace bullet_fem

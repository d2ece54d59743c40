// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <memory>
#include <string>

#include "tools/pictures/image.h"

namespace bullet_fem
{

/// Writes frames as a film through the program `ffmpeg`, which is not linked: it must be in PATH. The file gets its
/// name only in `finish`; a writer that is destroyed before leaves nothing behind.
class FilmWriter
{
public:
    /// Starts a film at `path`, ending in .mp4 (H.264) or .gif, with `framesPerSecond` in [1, 100]. Throws
    /// std::invalid_argument on another ending or rate or an empty size, std::runtime_error if there is no ffmpeg or
    /// the path cannot be written.
    FilmWriter(const std::string& path, const PictureSize& size, int framesPerSecond);
    ~FilmWriter();
    FilmWriter(const FilmWriter&) = delete;
    FilmWriter& operator=(const FilmWriter&) = delete;

    /// Throws std::invalid_argument on another size than the film's, std::runtime_error with ffmpeg's words if it has
    /// ended.
    void append(const Image& frame);
    /// Waits for ffmpeg and names the file; nothing can be appended then. Throws std::invalid_argument if there are no
    /// frames, std::runtime_error with ffmpeg's words if it failed.
    void finish();

    /// Whether there is an ffmpeg in PATH.
    static bool available();

private:
    struct Child;
    std::unique_ptr<Child> m_child;
    PictureSize m_size;
    int m_frames = 0;
};

}  // namespace bullet_fem

// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "demos/compare/compared_run.h"

namespace bullet_fem
{

/// The text in one half of the picture.
struct ComparedText
{
    std::string m_title;    ///< whose side it is
    std::string m_figures;  ///< below it
};

/// A film of 800 x 450 pixels whose left half is one side and whose right half the other, scene after scene:
/// film.mp4 and strip.png, six frames of each scene. A program without the renderer, or without ffmpeg, has none.
class ComparedFilm
{
public:
    /// Throws std::runtime_error if the folder cannot be written.
    explicit ComparedFilm(const std::string& folder);
    ~ComparedFilm();
    ComparedFilm(const ComparedFilm&) = delete;
    ComparedFilm& operator=(const ComparedFilm&) = delete;

    void add(const ComparedScene& scene, const ComparedRun& left, const ComparedText& leftText,
             const ComparedRun& right, const ComparedText& rightText);
    /// Returns what was written.
    std::vector<std::string> finish();

private:
    struct Pictures;
    std::string m_folder;
    std::unique_ptr<Pictures> m_pictures;
};

}  // namespace bullet_fem

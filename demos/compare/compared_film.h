// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "demos/compare/compared_run.h"

namespace bullet_fem
{

/// Text in one half of the picture.
struct ComparedText
{
    std::string m_title;    ///< name of the side
    std::string m_figures;  ///< text below the title
};

/// A film of 800 x 450 pixels with one side in each half, scene after scene (film.mp4), and six frames of each scene
/// (strip.png). A program without the renderer or without ffmpeg writes none.
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
    /// Returns the names of the files written.
    std::vector<std::string> finish();

private:
    struct Pictures;
    std::string m_folder;
    std::unique_ptr<Pictures> m_pictures;
};

}  // namespace bullet_fem

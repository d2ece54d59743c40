// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include "bullet_fem/fem/common/export.h"
#include "bullet_fem/io/body_frame.h"

namespace bullet_fem
{

/// What colours the bodies of a film.
enum class GlbColours
{
    plain,     ///< one colour a body
    vonMises,  ///< von Mises' stress of the instant; viewers may ignore that colours change, and show the first frame
    peakVonMises  ///< the highest of each vertex in the whole film; every viewer shows it
};

/// How a film is written.
struct GlbSettings
{
    bool m_stepped = false;  ///< frames follow each other with a jump (STEP), not along straight lines (LINEAR)
    bool m_normals = true;   ///< smooth shading, at the price of half the size; else viewers shade every triangle flat
    /// What vertices are coloured by.
    GlbColours m_colours = GlbColours::plain;
    bool m_zUp = false;     ///< the world's z is up: bodies are turned so that it is viewers' y
    double m_hottest = 0;   ///< von Mises' stress of the last colour [Pa], >= 0; 0: the highest in the film
    int m_maxFrames = 256;  ///< in [1, 65535]; many viewers hold no more than 256 morph targets
    std::size_t m_maxBytes = 512u << 20;  ///< of the file [B], in [1, 2^32 - 1], which is the format's limit
};

/// A run as one animated binary glTF 2.0 file: every frame is a morph target of the bodies' surfaces, every body a
/// node. Lengths are metres. Give it every k-th frame of the run: frames are kept, at 12
/// bytes a vertex and 4 more with colours, until write(). Not for bodies that come, go, or change their triangles.
class BULLETFEM_API GlbFilm
{
public:
    /// Throws std::invalid_argument on a setting out of its range.
    explicit GlbFilm(const GlbSettings& settings = {});
    ~GlbFilm();
    /// Moves: the other is not to be used then.
    GlbFilm(GlbFilm&&) noexcept;
    /// Likewise.
    GlbFilm& operator=(GlbFilm&&) noexcept;

    /// A frame at `time` [s], after the one before. Of the bodies the positions and triangles are used, and with
    /// colours the node stresses. Throws std::invalid_argument on what VtuSeries::writeBodies throws it on, on bodies
    /// without triangles, or without node stress where colours need it, or that are not those of the first frame; on a
    /// time that is not later; and if the film would have more frames or bytes than the settings allow. The frame is
    /// not added then.
    void addFrame(double time, const std::vector<BodyFrame>& bodies);

    /// Writes what there is so far; the film begins at 0 s. The file appears as a whole or not at all. Throws
    /// std::runtime_error naming the path if it cannot be written, std::invalid_argument if there is no frame.
    void write(const std::string& path) const;

    /// Frames so far.
    int frameCount() const;
    /// An upper bound of what write() would write now [B].
    std::size_t byteCount() const;
    /// Highest von Mises stress so far [Pa]; 0 without colours.
    double highestVonMises() const;

private:
    struct Impl;
    std::unique_ptr<Impl> m_impl;
};

}  // namespace bullet_fem

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

/// Colouring of the bodies of a film.
enum class GlbColours
{
    plain,  ///< one colour per body
    /// Von Mises stress of each frame; viewers may ignore changing colours and show those of the first frame.
    vonMises,
    peakVonMises  ///< maximum of each vertex over the film; every viewer shows it
};

/// Settings of a film.
struct GlbSettings
{
    bool m_stepped = false;  ///< frames change abruptly (STEP), instead of by linear interpolation (LINEAR)
    /// Writes normals for smooth shading, which double the size; without them viewers shade every triangle flat.
    bool m_normals = true;
    /// Colouring of the vertices.
    GlbColours m_colours = GlbColours::plain;
    bool m_zUp = false;     ///< the world's z axis is up: bodies are rotated so that it becomes the viewers' y
    double m_hottest = 0;   ///< von Mises stress of the top colour [Pa], >= 0; 0: the maximum in the film
    int m_maxFrames = 256;  ///< maximum number of frames, in [1, 65535]; many viewers support at most 256 morph targets
    /// Maximum size of the file [B], in [1, 2^32 - 1], which is the format's limit.
    std::size_t m_maxBytes = 512u << 20;
};

/// A simulation run as one animated binary glTF 2.0 file: every frame is a morph target of the bodies' surfaces, every
/// body a node. Lengths are metres. Add every k-th frame of the run: frames are kept in memory, at 12 bytes per vertex
/// and 4 more with colours, until write(). Not for bodies that appear, disappear, or change their triangles.
class BULLETFEM_API GlbFilm
{
public:
    /// An empty film. Throws std::invalid_argument on a setting out of its range.
    explicit GlbFilm(const GlbSettings& settings = {});
    ~GlbFilm();
    /// Moves; the source must not be used afterwards.
    GlbFilm(GlbFilm&&) noexcept;
    /// Moves; the source must not be used afterwards.
    GlbFilm& operator=(GlbFilm&&) noexcept;

    /// Adds a frame at `time` [s], which must be later than that of the previous frame. Uses positions and triangles of
    /// the bodies and, with colours, node stresses. Throws std::invalid_argument as VtuSeries::writeBodies does, on
    /// bodies without triangles or without required node stress, on bodies that differ from those of the first frame,
    /// on a time that is not later, and if the film would exceed the frames or bytes of the settings; the frame is not
    /// added then. Allocates.
    void addFrame(double time, const std::vector<BodyFrame>& bodies);

    /// Writes the frames so far, with times relative to the first. The file appears as a whole or not at all. Throws
    /// std::runtime_error naming the path if it cannot be written, std::invalid_argument if there is no frame.
    void write(const std::string& path) const;

    /// Number of frames so far.
    int frameCount() const;
    /// Upper bound of the present size of the file [B].
    std::size_t byteCount() const;
    /// Highest von Mises stress so far [Pa]; 0 without colours.
    double highestVonMises() const;

private:
    struct Impl;
    std::unique_ptr<Impl> m_impl;
};

}  // namespace bullet_fem

// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "bullet_fem/io/glb_film.h"

#include <algorithm>
#include <cmath>

#include "fem/common/message.h"
#include "fem/common/output_file.h"
#include "io/frames/body_frame_check.h"
#include "io/frames/glb_model.h"
#include "io/frames/surface_part.h"

namespace bullet_fem
{
namespace
{

constexpr const char* kCaller = "GlbFilm";
constexpr std::size_t kFormatsLimit = 0xFFFFFFFFu;
// Maximum sizes of the describing JSON text per file, per body, and per attribute of a body in a frame [B].
constexpr std::size_t kFileText = 2000, kBodyText = 2000, kAttributeText = 350;

void checkSettings(const GlbSettings& s)
{
    if (!(s.m_hottest >= 0) || !std::isfinite(s.m_hottest))
        reject(kCaller, ": m_hottest is ", s.m_hottest, " Pa; it must be in [0, inf), 0 for the highest in the film");
    if (s.m_maxFrames < 1 || s.m_maxFrames > 65535)
        reject(kCaller, ": m_maxFrames is ", s.m_maxFrames, "; it must be in [1, 65535]");
    if (s.m_maxBytes < 1 || s.m_maxBytes > kFormatsLimit)
        reject(kCaller, ": m_maxBytes is ", s.m_maxBytes, "; it must be in [1, ", kFormatsLimit, "]");
}

Float3 rounded(const Vec3& v)
{
    return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)};
}

std::vector<GlbBody> surfacesOf(const std::vector<BodyFrame>& bodies)
{
    std::vector<GlbBody> surfaces;
    for (const BodyFrame& body : bodies)
    {
        SurfacePart part(kCaller, body);
        surfaces.push_back({body.m_id,
                            body.m_positions.size(),
                            std::move(part.m_node),
                            body.m_triangles,
                            std::move(part.m_triangles),
                            {},
                            {}});
    }
    return surfaces;
}

}  // namespace

struct GlbFilm::Impl
{
    bool coloured() const { return m_settings.m_colours != GlbColours::plain; }

    void checkBodies(const std::vector<BodyFrame>& bodies) const
    {
        if (bodies.empty()) reject(kCaller, ": a frame needs one body at least");
        for (const BodyFrame& body : bodies)
            if (coloured() && body.m_nodeStress.empty())
                reject(kCaller, ": body ", body.m_id, " has no node stress; give it, or take GlbColours::plain");
        if (m_times.empty()) return;
        bool same = bodies.size() == m_bodies.size();
        for (std::size_t b = 0; same && b < bodies.size(); ++b)
            same = bodies[b].m_id == m_bodies[b].m_id && bodies[b].m_triangles == m_bodies[b].m_given &&
                   bodies[b].m_positions.size() == m_bodies[b].m_nodeCount;
        if (!same)
            reject(kCaller, ": the bodies are not those of the first frame, with the same ids, nodes and triangles");
    }

    void checkNextTime(double time) const
    {
        checkTime(kCaller, time);
        if (!m_times.empty() && !(static_cast<float>(time - m_start) > m_times.back()))
            reject(kCaller, ": the time is ", time, " s; it must be later than the last frame's, ",
                   m_start + m_times.back(), " s");
    }

    void checkSize(const std::vector<GlbBody>& bodies) const
    {
        const std::size_t frames = m_times.size() + 1, bytes = bytesOf(bodies, frames);
        if (frames > static_cast<std::size_t>(m_settings.m_maxFrames))
            reject(kCaller, ": this would be frame ", frames, " of ", m_settings.m_maxFrames,
                   " at most; take fewer frames of the run, or raise m_maxFrames");
        if (bytes > m_settings.m_maxBytes)
            reject(kCaller, ": with this frame the film would have up to ", bytes, " bytes of ", m_settings.m_maxBytes,
                   " at most; take fewer frames, do without normals, or raise m_maxBytes");
    }

    std::size_t bytesOf(const std::vector<GlbBody>& bodies, std::size_t frames) const
    {
        if (frames == 0) return 0;
        const bool moving = m_settings.m_colours == GlbColours::vonMises;
        const std::size_t attributes = 1 + m_settings.m_normals + moving;
        std::size_t bytes = kFileText + 4 * frames * frames;
        for (const GlbBody& body : bodies)
        {
            const std::size_t perFrame = body.m_node.size() * sizeof(Float3);
            bytes += kBodyText + frames * attributes * (perFrame + kAttributeText) +
                     body.m_triangles.size() * 3 * sizeof(std::uint32_t) + perFrame;
        }
        return bytes;
    }

    void add(const std::vector<BodyFrame>& bodies)
    {
        for (std::size_t b = 0; b < bodies.size(); ++b)
        {
            GlbBody& body = m_bodies[b];
            std::vector<Float3> positions;
            std::vector<float> stress;
            for (const int node : body.m_node)
            {
                positions.push_back(rounded(bodies[b].m_positions[node]));
                if (coloured()) stress.push_back(static_cast<float>(vonMises(bodies[b].m_nodeStress[node])));
            }
            body.m_position.push_back(std::move(positions));
            if (coloured()) body.m_vonMises.push_back(std::move(stress));
        }
    }

    GlbSettings m_settings;
    double m_start = 0;          // [s]
    std::vector<float> m_times;  // from m_start [s]
    std::vector<GlbBody> m_bodies;
};

GlbFilm::GlbFilm(const GlbSettings& settings)
{
    checkSettings(settings);
    m_impl = std::make_unique<Impl>();
    m_impl->m_settings = settings;
}

GlbFilm::~GlbFilm() = default;
GlbFilm::GlbFilm(GlbFilm&&) noexcept = default;
GlbFilm& GlbFilm::operator=(GlbFilm&&) noexcept = default;

void GlbFilm::addFrame(double time, const std::vector<BodyFrame>& bodies)
{
    Impl& film = *m_impl;
    film.checkNextTime(time);
    checkFrame(kCaller, bodies);
    film.checkBodies(bodies);
    const bool first = film.m_times.empty();
    std::vector<GlbBody> surfaces;
    if (first) surfaces = surfacesOf(bodies);
    film.checkSize(first ? surfaces : film.m_bodies);

    if (first)
    {
        film.m_bodies = std::move(surfaces);
        film.m_start = time;
    }
    film.add(bodies);
    film.m_times.push_back(static_cast<float>(time - film.m_start));
}

void GlbFilm::write(const std::string& path) const
{
    if (frameCount() == 0) reject(kCaller, ": there is no frame to be written to '", path, "'; add one");
    const GlbSettings& settings = m_impl->m_settings;
    double hottest = 0;
    if (m_impl->coloured()) hottest = settings.m_hottest > 0 ? settings.m_hottest : highestVonMises();
    if (m_impl->coloured() && !(hottest > 0)) hottest = 1;  // no stress anywhere
    writeOutputFile(path, glbBytes({m_impl->m_bodies, m_impl->m_times, settings.m_stepped, settings.m_normals,
                                    settings.m_zUp, settings.m_colours == GlbColours::peakVonMises, hottest}));
}

int GlbFilm::frameCount() const
{
    return static_cast<int>(m_impl->m_times.size());
}

std::size_t GlbFilm::byteCount() const
{
    return m_impl->bytesOf(m_impl->m_bodies, m_impl->m_times.size());
}

double GlbFilm::highestVonMises() const
{
    float highest = 0;
    for (const GlbBody& body : m_impl->m_bodies)
        for (const std::vector<float>& frame : body.m_vonMises)
            for (const float s : frame) highest = std::max(highest, s);
    return highest;
}

}  // namespace bullet_fem

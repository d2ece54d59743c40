// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "bullet_fem/io/surface_writer.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>

#include "bullet_fem/io/colour_map.h"
#include "fem/common/message.h"
#include "fem/common/output_file.h"
#include "io/frames/body_frame_check.h"
#include "io/frames/surface_part.h"
#include "io/text/written_number.h"

namespace bullet_fem
{
namespace
{

std::vector<SurfacePart> partsOf(const char* caller, const std::vector<BodyFrame>& bodies)
{
    checkFrame(caller, bodies);
    std::vector<SurfacePart> parts;
    for (const BodyFrame& body : bodies) parts.emplace_back(caller, body);
    return parts;
}

/// Little endian on every machine.
void appendWord(std::string& bytes, std::uint32_t word)
{
    for (int k = 0; k < 4; ++k) bytes += static_cast<char>(word >> 8 * k & 255);
}

void appendFloat(std::string& bytes, double value)
{
    const float single = static_cast<float>(value);
    std::uint32_t word;
    std::memcpy(&word, &single, sizeof word);
    appendWord(bytes, word);
}

double vonMisesOf(const BodyFrame& body, int node)
{
    return body.m_nodeStress.empty() ? 0 : vonMises(body.m_nodeStress[node]);
}

double highestVonMises(const std::vector<BodyFrame>& bodies)
{
    double highest = 0;
    for (const BodyFrame& body : bodies)
        for (const Stress& stress : body.m_nodeStress) highest = std::max(highest, vonMises(stress));
    return highest;
}

std::string plyHeader(const std::vector<SurfacePart>& parts, bool stressed)
{
    std::size_t vertices = 0, triangles = 0;
    for (const SurfacePart& part : parts)
    {
        vertices += part.m_node.size();
        triangles += part.m_triangles.size();
    }
    std::string header =
        "ply\nformat binary_little_endian 1.0\ncomment BulletFEM, metres and pascals\nelement vertex " +
        std::to_string(vertices) + "\nproperty float x\nproperty float y\nproperty float z\n";
    if (stressed) header += "property float von_mises\nproperty uchar red\nproperty uchar green\nproperty uchar blue\n";
    return header + "element face " + std::to_string(triangles) +
           "\nproperty list uchar int vertex_indices\nproperty int body\nend_header\n";
}

void appendVertex(std::string& bytes, const BodyFrame& body, int node, double hottest)
{
    for (int i = 0; i < 3; ++i) appendFloat(bytes, body.m_positions[node][i]);
    if (!(hottest > 0)) return;
    const double stress = vonMisesOf(body, node);
    appendFloat(bytes, stress);
    const Vec3 colour = viridis(stress / hottest);
    for (int i = 0; i < 3; ++i) bytes += static_cast<char>(std::lround(255 * colour[i]));
}

}  // namespace

void writeObj(const std::string& path, const std::vector<BodyFrame>& bodies)
{
    const std::vector<SurfacePart> parts = partsOf("writeObj", bodies);
    std::string text = "# BulletFEM, metres\n";
    int first = 1;  // OBJ counts from 1
    for (std::size_t b = 0; b < bodies.size(); ++b)
    {
        text += "o body_" + std::to_string(bodies[b].m_id) + "\n";
        for (const int node : parts[b].m_node)
        {
            const Vec3& x = bodies[b].m_positions[node];
            text += "v " + writtenNumber(x.x) + " " + writtenNumber(x.y) + " " + writtenNumber(x.z) + "\n";
        }
        for (const Triangle& t : parts[b].m_triangles)
            text += "f " + std::to_string(first + t[0]) + " " + std::to_string(first + t[1]) + " " +
                    std::to_string(first + t[2]) + "\n";
        first += static_cast<int>(parts[b].m_node.size());
    }
    writeOutputFile(path, text);
}

void writePly(const std::string& path, const std::vector<BodyFrame>& bodies, double hottest)
{
    if (!(hottest >= 0) || !std::isfinite(hottest))
        reject("writePly: the hottest stress is ", hottest, " Pa; it must be in [0, inf), 0 for the highest there is");
    const std::vector<SurfacePart> parts = partsOf("writePly", bodies);
    const bool stressed =
        std::any_of(bodies.begin(), bodies.end(), [](const BodyFrame& body) { return !body.m_nodeStress.empty(); });
    if (!(hottest > 0)) hottest = std::max(highestVonMises(bodies), 1e-30);  // avoids division by zero without stress
    std::string bytes = plyHeader(parts, stressed);
    for (std::size_t b = 0; b < bodies.size(); ++b)
        for (const int node : parts[b].m_node) appendVertex(bytes, bodies[b], node, stressed ? hottest : 0);
    std::uint32_t first = 0;
    for (std::size_t b = 0; b < bodies.size(); ++b)
    {
        for (const Triangle& t : parts[b].m_triangles)
        {
            bytes += '\3';
            for (const int v : t) appendWord(bytes, first + static_cast<std::uint32_t>(v));
            appendWord(bytes, static_cast<std::uint32_t>(bodies[b].m_id));
        }
        first += static_cast<std::uint32_t>(parts[b].m_node.size());
    }
    writeOutputFile(path, bytes);
}

}  // namespace bullet_fem

// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors

// Assimp 5.2's own OFF reader loses the last face of a file without a final line break and every polygon of more than
// nine corners, moves indices that are out of range, and allocates what the header claims: hence this one.
#include <cstdint>

#include "io/surface/polygon_mesh.h"
#include "io/text/number_text.h"

namespace bullet_fem
{
namespace
{

/// The lines of a text, without comments and blank lines.
class Lines
{
public:
    explicit Lines(std::string_view text) : m_rest(text) {}

    /// The next line without its comment; throws at the end, naming what was `wanted`.
    std::string_view next(const std::string& wanted)
    {
        while (!m_rest.empty())
        {
            const std::size_t length = m_rest.find('\n');
            std::string_view line = m_rest.substr(0, length);
            m_rest.remove_prefix(length == std::string_view::npos ? m_rest.size() : length + 1);
            ++m_number;
            line = line.substr(0, line.find('#'));
            if (line.find_first_not_of(" \t\r\v\f") != std::string_view::npos) return line;
        }
        throw std::runtime_error("the file ends where " + wanted + " should be");
    }
    int number() const { return m_number; }

private:
    std::string_view m_rest;
    int m_number = 0;
};

// The word OFF is optional, as in geomview: the counts may come first.
void readHeader(Lines& lines, std::int64_t& vertexCount, std::int64_t& faceCount)
{
    std::string_view line = lines.next("the header OFF");
    const std::string_view kind = takeWord(line);
    const bool isCount = kind.find_first_not_of("0123456789") == std::string_view::npos;
    bool known = isCount;
    for (const char* name : {"OFF", "COFF", "NOFF", "CNOFF", "NCOFF", "STOFF", "STCOFF", "STNOFF", "STCNOFF"})
        known = known || kind == name;
    if (!known)
        throw std::runtime_error("'" + printable(kind) +
                                 "' is not a known OFF header (OFF, or with the prefixes ST, C, N)");
    std::string_view word = isCount ? kind : takeWord(line);
    if (word == "BINARY") throw std::runtime_error("binary OFF is not supported; save it as text");
    if (word.empty())
    {
        line = lines.next("the vertex and face counts");
        word = takeWord(line);
    }
    vertexCount = parseNumber<std::int64_t>(word, "a vertex count");
    faceCount = parseNumber<std::int64_t>(takeWord(line), "a face count");
    if (vertexCount < 0 || faceCount < 0) throw std::runtime_error("the vertex or face count is negative");
}

Vec3 readPosition(std::string_view line)
{
    Vec3 x;  // further values on the line are a normal, a colour or a texture coordinate
    for (int i = 0; i < 3; ++i) x[i] = parseNumber<double>(takeWord(line), "a coordinate");
    return x;
}

void readFace(std::string_view line, PolygonMesh& mesh)
{
    const int cornerCount = parseNumber<int>(takeWord(line), "a number of corners");
    for (int i = 0; i < cornerCount; ++i) mesh.m_corners.push_back(parseNumber<int>(takeWord(line), "a vertex index"));
    mesh.closeFace();
}

}  // namespace

PolygonMesh readOff(std::string_view text)
{
    Lines lines(text);
    try
    {
        std::int64_t vertexCount = 0, faceCount = 0;
        readHeader(lines, vertexCount, faceCount);
        PolygonMesh mesh;
        for (std::int64_t i = 0; i < vertexCount; ++i)
            mesh.m_positions.push_back(
                readPosition(lines.next("vertex " + std::to_string(i) + " of " + std::to_string(vertexCount))));
        for (std::int64_t i = 0; i < faceCount; ++i)
            readFace(lines.next("face " + std::to_string(i) + " of " + std::to_string(faceCount)), mesh);
        return mesh;
    }
    catch (const std::runtime_error& error)
    {
        throw std::runtime_error("line " + std::to_string(lines.number()) + ": " + error.what());
    }
}

}  // namespace bullet_fem

// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "io/frames/vtu_frame.h"

#include "io/frames/vtu_array.h"

namespace bullet_fem
{
namespace
{

constexpr std::uint8_t kTriangle = 5, kTetrahedron = 10;  // VTK_TRIANGLE, VTK_TETRA

/// The bodies' cells, one after the other.
struct Cells
{
    std::vector<std::int32_t> m_connectivity, m_offsets, m_body;
    std::vector<std::uint8_t> m_types;

    template <class Cell>
    void append(const std::vector<Cell>& cells, std::uint8_t type, std::int32_t firstNode, int id)
    {
        for (const Cell& cell : cells)
        {
            for (const int node : cell) m_connectivity.push_back(firstNode + node);
            m_offsets.push_back(static_cast<std::int32_t>(m_connectivity.size()));
            m_types.push_back(type);
            m_body.push_back(id);
        }
    }
};

bool showsTets(const BodyFrame& body)
{
    return !body.m_tets.empty();
}

Cells cellsOf(const std::vector<BodyFrame>& bodies)
{
    Cells cells;
    std::int32_t firstNode = 0;
    for (const BodyFrame& body : bodies)
    {
        if (showsTets(body))
            cells.append(body.m_tets, kTetrahedron, firstNode, body.m_id);
        else
            cells.append(body.m_triangles, kTriangle, firstNode, body.m_id);
        firstNode += static_cast<std::int32_t>(body.m_positions.size());
    }
    return cells;
}

void appendNumbers(std::vector<double>& numbers, const Vec3& v)
{
    numbers.insert(numbers.end(), {v.x, v.y, v.z});
}

void appendNumbers(std::vector<double>& numbers, const Stress& s)
{
    numbers.insert(numbers.end(), {s.xx, s.yy, s.zz, s.xy, s.yz, s.xz});
}

void appendNumbers(std::vector<double>& numbers, double value)
{
    numbers.push_back(value);
}

/// One array of the file: a field of all bodies, zero for a body without it; empty if no body has it.
template <class Value, class Count>
std::vector<double> joined(const std::vector<BodyFrame>& bodies, std::vector<Value> BodyFrame::*field,
                           const Count& count)
{
    std::vector<double> numbers;
    bool some = false;
    for (const BodyFrame& body : bodies)
    {
        const std::vector<Value>& values = body.*field;
        some = some || !values.empty();
        for (const Value& value : values) appendNumbers(numbers, value);
        for (std::size_t i = values.size(); i < count(body); ++i) appendNumbers(numbers, Value());
    }
    return some ? numbers : std::vector<double>();
}

std::size_t nodeCount(const BodyFrame& body)
{
    return body.m_positions.size();
}

std::size_t cellCount(const BodyFrame& body)
{
    return showsTets(body) ? body.m_tets.size() : body.m_triangles.size();
}

/// Labels of all cells, 0 for a body without labels; empty if no body has them.
std::vector<std::int32_t> regionsOf(const std::vector<BodyFrame>& bodies)
{
    std::vector<std::int32_t> regions;
    bool some = false;
    for (const BodyFrame& body : bodies)
    {
        some = some || !body.m_tetRegion.empty();
        regions.insert(regions.end(), body.m_tetRegion.begin(), body.m_tetRegion.end());
        regions.insert(regions.end(), cellCount(body) - body.m_tetRegion.size(), 0);
    }
    return some ? regions : std::vector<std::int32_t>();
}

/// Writes the arrays of one file.
struct FrameText
{
    std::string& m_xml;
    VtuEncoding m_encoding;

    void append(const VtuArray& array, const std::vector<double>& values) const
    {
        if (!values.empty()) appendArray(m_xml, m_encoding, array, values);
    }

    void appendStress(const std::vector<double>& stress) const
    {
        append({"stress", 6, {"XX", "YY", "ZZ", "XY", "YZ", "XZ"}}, stress);
        std::vector<double> equivalent;
        for (std::size_t i = 0; i < stress.size(); i += 6)
            equivalent.push_back(
                vonMises({stress[i], stress[i + 1], stress[i + 2], stress[i + 3], stress[i + 4], stress[i + 5]}));
        append({"von_mises", 1, {}}, equivalent);
    }
};

void appendPointData(const FrameText& text, const std::vector<BodyFrame>& bodies)
{
    const auto vectors = [&bodies](std::vector<Vec3> BodyFrame::*field) { return joined(bodies, field, nodeCount); };
    const std::vector<double> displacement = vectors(&BodyFrame::m_displacement);
    const std::vector<double> stress = joined(bodies, &BodyFrame::m_nodeStress, nodeCount);
    text.m_xml += "<PointData";
    if (!stress.empty()) text.m_xml += " Scalars=\"von_mises\"";
    if (!displacement.empty()) text.m_xml += " Vectors=\"displacement\"";
    text.m_xml += ">\n";
    text.append({"displacement", 3, {}}, displacement);
    text.append({"velocity", 3, {}}, vectors(&BodyFrame::m_velocity));
    text.append({"contact_force", 3, {}}, vectors(&BodyFrame::m_contactForce));
    text.append({"reaction_force", 3, {}}, vectors(&BodyFrame::m_reactionForce));
    text.appendStress(stress);
    text.m_xml += "</PointData>\n";
}

void appendCellData(const FrameText& text, const std::vector<BodyFrame>& bodies, const Cells& cells)
{
    text.m_xml += "<CellData>\n";
    appendArray(text.m_xml, text.m_encoding, {"body", 1, {}}, cells.m_body);
    if (const std::vector<std::int32_t> regions = regionsOf(bodies); !regions.empty())
        appendArray(text.m_xml, text.m_encoding, {"region", 1, {}}, regions);
    text.appendStress(joined(bodies, &BodyFrame::m_tetStress, cellCount));
    text.append({"plastic_strain", 1, {}}, joined(bodies, &BodyFrame::m_tetPlasticStrain, cellCount));
    text.append({"activation", 1, {}}, joined(bodies, &BodyFrame::m_tetActivation, cellCount));
    text.m_xml += "</CellData>\n";
}

std::string pieceHead(VtuEncoding encoding, std::size_t pointCount, std::size_t cellCount)
{
    return "<?xml version=\"1.0\"?>\n<VTKFile type=\"UnstructuredGrid\" version=\"1.0\"" +
           encodingAttributes(encoding) + ">\n<UnstructuredGrid>\n<Piece NumberOfPoints=\"" +
           std::to_string(pointCount) + "\" NumberOfCells=\"" + std::to_string(cellCount) + "\">\n";
}

/// The grid and the end of the file.
void appendGrid(const FrameText& text, const std::vector<double>& points, const Cells& cells, bool exact)
{
    std::string& xml = text.m_xml;
    xml += "<Points>\n";
    appendArray(xml, text.m_encoding, {"Points", 3, {}, exact}, points);
    xml += "</Points>\n<Cells>\n";
    appendArray(xml, text.m_encoding, {"connectivity", 0, {}}, cells.m_connectivity);
    appendArray(xml, text.m_encoding, {"offsets", 0, {}}, cells.m_offsets);
    appendArray(xml, text.m_encoding, {"types", 0, {}}, cells.m_types);
    xml += "</Cells>\n</Piece>\n</UnstructuredGrid>\n</VTKFile>\n";
}

}  // namespace

std::string vtuFrame(const std::vector<BodyFrame>& bodies, VtuEncoding encoding, bool named)
{
    const Cells cells = cellsOf(bodies);
    std::vector<double> points;
    for (const BodyFrame& body : bodies)
        for (const Vec3& x : body.m_positions) appendNumbers(points, x);

    std::string xml = pieceHead(encoding, points.size() / 3, cells.m_types.size());
    const FrameText text{xml, encoding};
    appendPointData(text, bodies);
    if (named) appendCellData(text, bodies, cells);
    appendGrid(text, points, cells, false);
    return xml;
}

std::string vtuMesh(const TetMesh& mesh, const std::vector<int>& regions)
{
    Cells cells;
    cells.append(mesh.tets(), kTetrahedron, 0, 0);
    std::vector<double> points;
    for (const Vec3& x : mesh.restPositions()) appendNumbers(points, x);
    std::string xml = pieceHead(VtuEncoding::text, mesh.restPositions().size(), cells.m_types.size());
    if (!regions.empty())
    {
        xml += "<CellData>\n";
        appendArray(xml, VtuEncoding::text, {"region", 1, {}}, std::vector<std::int32_t>(regions));
        xml += "</CellData>\n";
    }
    appendGrid({xml, VtuEncoding::text}, points, cells, true);
    return xml;
}

}  // namespace bullet_fem

// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include <tinyxml2.h>

#include <stdexcept>

#include "fem/common/message.h"
#include "io/tet/tet_readers.h"
#include "io/tet/vtk_cells.h"
#include "io/tet/vtu_array.h"

namespace bullet_fem
{
namespace
{

using tinyxml2::XMLElement;

// Limit of decoded numbers, in total and per byte of the file: genuine files have one number per byte or two, and some
// ten in grids that compress well; small zlib files, or pieces that share arrays, could otherwise exhaust the memory.
constexpr std::uint64_t kNumbers = 1000000, kNumbersPerByte = 12;

[[noreturn]] void failInVtu(const XMLElement& element, const std::string& cause)
{
    throw std::runtime_error(message("line ", element.GetLineNum(), ": ", cause));
}

/// Removes the contents of <AppendedData>, which are no XML, from the file; returns the rest as XML.
std::string cutAppendedData(std::string_view bytes, std::string_view& data)
{
    const std::size_t tag = bytes.find("<AppendedData");
    if (tag == std::string_view::npos) return std::string(bytes);
    const std::size_t open = bytes.find('>', tag), close = bytes.rfind("</AppendedData");
    if (open == std::string_view::npos || close == std::string_view::npos || close < open)
        throw std::runtime_error(message("byte ", tag, ": <AppendedData> has no end; the file is cut short"));
    data = bytes.substr(open + 1, close - open - 1);
    const std::size_t mark = data.find_first_not_of(" \t\r\n");
    if (mark == std::string_view::npos || data[mark] != '_')
        throw std::runtime_error(message("byte ", open + 1, ": AppendedData must begin with an underscore"));
    data.remove_prefix(mark + 1);
    return std::string(bytes.substr(0, open + 1)) + std::string(bytes.substr(close));
}

ByteOrder readOrder(const XMLElement& root)
{
    const std::string order = vtuAttribute(root, "byte_order", "LittleEndian");
    if (order != "LittleEndian" && order != "BigEndian")
        failInVtu(root, "byte_order is '" + order + "'; it must be LittleEndian or BigEndian");
    return order == "BigEndian" ? ByteOrder::big : ByteOrder::little;
}

VtuArrayEncoding readEncoding(const XMLElement& root)
{
    VtuArrayEncoding encoding;
    encoding.order = readOrder(root);
    const std::string header = vtuAttribute(root, "header_type", "UInt32");
    if (header != "UInt32" && header != "UInt64")
        failInVtu(root, "header_type is '" + header + "'; it must be UInt32 or UInt64");
    encoding.headerBytes = header == "UInt64" ? 8 : 4;
    const std::string compressor = vtuAttribute(root, "compressor");
    if (!compressor.empty() && compressor != "vtkZLibDataCompressor")
        failInVtu(root, "the compressor '" + compressor + "' is not known; save with zlib or without compression");
    encoding.compressed = !compressor.empty();
    if (const XMLElement* appended = root.FirstChildElement("AppendedData"))
    {
        const std::string kind = vtuAttribute(*appended, "encoding");
        if (kind != "raw" && kind != "base64")
            failInVtu(*appended, "the encoding of AppendedData is '" + kind + "'; it must be raw or base64");
        encoding.appendedBase64 = kind == "base64";
    }
    return encoding;
}

const XMLElement& childOf(const XMLElement& element, const char* name)
{
    const XMLElement* child = element.FirstChildElement(name);
    if (!child) failInVtu(element, message("<", element.Name(), "> has no <", name, ">"));
    return *child;
}

const XMLElement& namedArray(const XMLElement& cells, const std::string& name)
{
    for (const XMLElement* a = cells.FirstChildElement("DataArray"); a; a = a->NextSiblingElement("DataArray"))
        if (vtuAttribute(*a, "Name") == name) return *a;
    failInVtu(cells, "<Cells> has no DataArray '" + name + "'");
}

std::uint64_t countOf(const XMLElement& piece, const char* name)
{
    try
    {
        return parseNumber<std::uint64_t>(vtuAttribute(piece, name, "0"), name);
    }
    catch (const std::runtime_error& error)
    {
        failInVtu(piece, error.what());
    }
}

void readPoints(const XMLElement& piece, VtuArrayEncoding& encoding, TetMeshFile& mesh)
{
    const std::uint64_t count = countOf(piece, "NumberOfPoints");
    const XMLElement& points = childOf(piece, "Points");
    const XMLElement& array = childOf(points, "DataArray");
    const std::string components = vtuAttribute(array, "NumberOfComponents", "3");
    if (components != "3") failInVtu(array, "points have " + components + " components, not 3");
    const std::vector<double> x = readVtuDoubles(array, encoding);
    if (x.size() % 3 != 0 || x.size() / 3 != count)
        failInVtu(array, message(x.size(), " coordinates for ", count, " points"));
    for (std::size_t i = 0; i < x.size(); i += 3)
    {
        mesh.m_nodeNumbers.push_back(mesh.m_positions.size());
        mesh.m_positions.push_back({x[i], x[i + 1], x[i + 2]});
    }
}

void readRegions(const XMLElement& piece, const VtkCells& cells, VtuArrayEncoding& encoding, TetMeshFile& mesh)
{
    const XMLElement* data = piece.FirstChildElement("CellData");
    for (const XMLElement* a = data ? data->FirstChildElement("DataArray") : nullptr; a;
         a = a->NextSiblingElement("DataArray"))
        if (isVtkRegionName(vtuAttribute(*a, "Name")) && vtuAttribute(*a, "NumberOfComponents", "1") == "1")
            return noteVtkRegions(mesh, cells, readVtuDoubles(*a, encoding));
}

void readPiece(const XMLElement& piece, VtuArrayEncoding& encoding, TetMeshFile& mesh)
{
    const std::uint64_t cellCount = countOf(piece, "NumberOfCells");
    if (countOf(piece, "NumberOfPoints") == 0 && cellCount == 0) return;
    const std::size_t firstPoint = mesh.m_positions.size();
    readPoints(piece, encoding, mesh);
    const XMLElement& element = childOf(piece, "Cells");
    VtkCells cells;
    cells.m_connectivity = readVtuIntegers(namedArray(element, "connectivity"), encoding);
    cells.m_ends = readVtuIntegers(namedArray(element, "offsets"), encoding);
    cells.m_types = readVtuIntegers(namedArray(element, "types"), encoding);
    if (cells.m_ends.size() != cellCount)
        failInVtu(element, message(cells.m_ends.size(), " offsets for ", cellCount, " cells"));
    try
    {
        appendVtkCells(mesh, cells, firstPoint);
    }
    catch (const std::runtime_error& error)
    {
        failInVtu(element, error.what());
    }
    readRegions(piece, cells, encoding, mesh);
    if (!mesh.m_regions.empty()) mesh.m_regions.resize(mesh.m_tets.size(), 0);
}

}  // namespace

TetMeshFile readVtu(std::string_view bytes)
{
    std::string_view appended;
    const std::string xml = cutAppendedData(bytes, appended);
    tinyxml2::XMLDocument document;
    if (document.Parse(xml.data(), xml.size()) != tinyxml2::XML_SUCCESS)
        throw std::runtime_error(
            message("line ", document.ErrorLineNum(), ": this is not XML (", document.ErrorName(), ")"));
    const XMLElement* root = document.RootElement();
    if (!root || std::string_view(root->Name()) != "VTKFile")
        throw std::runtime_error("line 1: the file has no <VTKFile>");
    const std::string type = vtuAttribute(*root, "type");
    if (type != "UnstructuredGrid")
        failInVtu(*root, "the type is '" + type + "'; tetrahedra are in an UnstructuredGrid only");

    VtuArrayEncoding encoding = readEncoding(*root);
    encoding.appended = appended;
    encoding.numbersLeft = kNumbers + kNumbersPerByte * std::uint64_t{bytes.size()};
    TetMeshFile mesh;
    mesh.m_format = "VTK XML";
    mesh.m_version = vtuAttribute(*root, "version");
    const XMLElement& grid = childOf(*root, "UnstructuredGrid");
    for (const XMLElement* piece = grid.FirstChildElement("Piece"); piece; piece = piece->NextSiblingElement("Piece"))
        readPiece(*piece, encoding, mesh);
    return mesh;
}

}  // namespace bullet_fem

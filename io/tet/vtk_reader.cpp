// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include <stdexcept>

#include "fem/common/message.h"
#include "io/tet/tet_readers.h"
#include "io/tet/vtk_file.h"

namespace bullet_fem
{
namespace
{

void readHeader(VtkFile& file)
{
    MeshScanner& scanner = file.scanner;
    constexpr std::string_view magic = "vtk DataFile Version ";
    std::string_view rest = scanner.restOfLine();
    const bool marked = rest.substr(0, 1) == "#";
    rest.remove_prefix(marked ? 1 : 0);
    if (rest.substr(0, 1) == " ") rest.remove_prefix(1);  // Bullet's own files omit the blank
    if (!marked || vtkKeyword(rest.substr(0, magic.size())) != vtkKeyword(magic))
        scanner.fail("a VTK file begins with '# vtk DataFile Version'");
    rest.remove_prefix(magic.size());
    const std::string version = printable(takeWord(rest));
    file.major = scanner.parse<int>(std::string_view(version).substr(0, version.find('.')), "a version");
    if (file.major < 1 || file.major > 5) scanner.fail("the version is " + version + "; it must be in [1.0, 5.1]");
    scanner.restOfLine();  // the title
    const std::string encoding = vtkKeyword(scanner.word("ASCII or BINARY"));
    if (encoding != "ASCII" && encoding != "BINARY") scanner.fail("the encoding must be ASCII or BINARY");
    scanner.restOfLine();
    if (encoding == "BINARY") scanner.setBinary(ByteOrder::big);
    file.mesh.m_format = "VTK legacy";
    file.mesh.m_version = version + (scanner.isBinary() ? " binary" : " text");
}

void readPoints(VtkFile& file)
{
    MeshScanner& scanner = file.scanner;
    if (file.hasPoints) scanner.fail("there is a second section POINTS");
    file.hasPoints = true;
    const auto count = scanner.text<std::uint64_t>("a number of points");
    const NumberType type = vtkNumberType(scanner, scanner.word("a type of coordinates"));
    scanner.restOfLine();
    scanner.need(count, 1, 1, "points");
    const std::vector<double> x = readVtkDoubles(file, type, 3 * count, "a coordinate");
    for (std::uint64_t i = 0; i < count; ++i)
    {
        file.mesh.m_positions.push_back({x[3 * i], x[3 * i + 1], x[3 * i + 2]});
        file.mesh.m_nodeNumbers.push_back(i);
    }
}

/// Whether the section continues in a text file: with a number, because a section begins with a letter.
bool atNumber(MeshScanner& scanner)
{
    const std::string_view word = scanner.peekWord();
    return !word.empty() && !(word[0] >= 'A' && word[0] <= 'Z') && !(word[0] >= 'a' && word[0] <= 'z');
}

std::int64_t readCellNumber(MeshScanner& scanner)
{
    constexpr const char* what = "a cell's number";
    if (!scanner.isBinary()) return scanner.text<std::int64_t>(what);
    return integerFromBits(scanner.bits(4, what), {NumberType::signedInteger, 4});
}

/// CELLS before version 5: for each cell the number of its corners, then these. The declared total of numbers is not
/// always correct; cells are counted instead.
void readCellRows(VtkFile& file, std::uint64_t cellCount, std::int64_t declared)
{
    MeshScanner& scanner = file.scanner;
    VtkCells& cells = file.cells;
    for (std::uint64_t c = 0; c < cellCount; ++c)
    {
        if (scanner.isBinary() ? scanner.left() < 4 : !atNumber(scanner))
            scanner.fail(message("of ", cellCount, " CELLS only ", c, " are there"));
        const std::int64_t corners = readCellNumber(scanner);
        if (corners < 0 || static_cast<std::uint64_t>(corners) > scanner.left())
            scanner.fail(message("cell ", c, " has ", corners, " corners where ", scanner.left(), " bytes are left"));
        for (std::int64_t i = 0; i < corners; ++i) cells.m_connectivity.push_back(readCellNumber(scanner));
        cells.m_ends.push_back(static_cast<std::int64_t>(cells.m_connectivity.size()));
    }
    const std::size_t read = cells.m_connectivity.size() + cells.m_ends.size();
    if (declared >= 0 && static_cast<std::uint64_t>(declared) == read) return;
    if (atNumber(scanner))
        scanner.fail(message("CELLS of ", cellCount, " cells have ", read, " numbers, not ", declared,
                             ", and more follow; correct the number of cells"));
    file.mesh.m_notes.push_back(message(file.cellsPlace.place(), ": CELLS should state ", read, " numbers for ",
                                        cellCount, " cells, not ", declared, "; read cell by cell"));
}

std::vector<std::int64_t> readNamedIntegers(VtkFile& file, const char* name, std::uint64_t count)
{
    MeshScanner& scanner = file.scanner;
    if (vtkKeyword(scanner.word(name)) != name) scanner.fail(message("here ", name, " should be"));
    const NumberType type = vtkNumberType(scanner, scanner.word("a type of integers"));
    scanner.restOfLine();
    return readVtkIntegers(file, type, count, name);
}

/// CELLS from version 5 on: OFFSETS, one more than there are cells, and CONNECTIVITY.
void readCellArrays(VtkFile& file, std::uint64_t offsetCount, std::uint64_t size)
{
    std::vector<std::int64_t> offsets = readNamedIntegers(file, "OFFSETS", offsetCount);
    if (!offsets.empty() && offsets.front() != 0)
        file.scanner.fail(message("the first of the OFFSETS is ", offsets.front(), ", not 0"));
    if (!offsets.empty()) file.cells.m_ends.assign(offsets.begin() + 1, offsets.end());
    file.cells.m_connectivity = readNamedIntegers(file, "CONNECTIVITY", size);
}

void readCells(VtkFile& file)
{
    MeshScanner& scanner = file.scanner;
    if (file.hasCells) scanner.fail("there is a second section CELLS");
    file.hasCells = true;
    file.cellsPlace = scanner;
    const auto count = scanner.text<std::uint64_t>("a number of cells");
    std::string_view rest = scanner.restOfLine();
    const std::string_view size = takeWord(rest);
    if (file.major >= 5)
        readCellArrays(file, count, scanner.parse<std::uint64_t>(size, "a number of integers"));
    else
        readCellRows(file, count, size.empty() ? 0 : scanner.parse<std::int64_t>(size, "a number of integers"));
}

// In text files reads all types up to the next section, whatever their declared number.
void readCellTypes(VtkFile& file)
{
    MeshScanner& scanner = file.scanner;
    if (file.hasTypes) scanner.fail("there is a second section CELL_TYPES");
    file.hasTypes = true;
    file.typesPlace = scanner.place();
    file.declaredTypes = scanner.text<std::uint64_t>("a number of cell types");
    if (scanner.isBinary())
    {
        scanner.restOfLine();
        file.cells.m_types = readVtkIntegers(file, {NumberType::signedInteger, 4}, file.declaredTypes, "a cell type");
    }
    else
        while (atNumber(scanner)) file.cells.m_types.push_back(scanner.text<std::int64_t>("a cell type"));
}

/// If the types are incomplete, cells with four corners are tetrahedra unless a type says otherwise.
void settleCellTypes(VtkFile& file)
{
    VtkCells& cells = file.cells;
    const std::size_t count = cells.m_ends.size(), given = cells.m_types.size();
    const std::string told =
        file.hasTypes ? message(file.typesPlace, ": CELL_TYPES lists ", given, " types for ", count, " cells")
                      : message(file.cellsPlace.place(), ": behind CELLS the file has no section CELL_TYPES");
    std::vector<std::string>& notes = file.mesh.m_notes;
    if (file.hasTypes && given == count)
    {
        if (file.declaredTypes != given) notes.push_back(message(told, ", but states ", file.declaredTypes));
        return;
    }
    bool areTets = given <= count;
    for (std::size_t c = 0; c < count; ++c)
        areTets = areTets && cells.m_ends[c] == static_cast<std::int64_t>(4 * (c + 1));
    for (const std::int64_t type : cells.m_types) areTets = areTets && type == kVtkTetrahedron;
    if (!areTets) throw std::runtime_error(told + "; list the type of each, 10 for a tetrahedron");
    cells.m_types.assign(count, kVtkTetrahedron);
    notes.push_back(told + "; all cells have four corners and are taken for tetrahedra");
}

/// Reads a section of the grid; returns false at the beginning of point or cell data, which ends the mesh.
bool readSection(VtkFile& file)
{
    const std::string_view word = file.scanner.word("a section");
    const std::string keyword = vtkKeyword(word);
    if (keyword == "POINT_DATA" || keyword == "CELL_DATA")
    {
        file.data = keyword;
        return false;
    }
    if (keyword == "POINTS")
        readPoints(file);
    else if (keyword == "CELLS")
        readCells(file);
    else if (keyword == "CELL_TYPES")
        readCellTypes(file);
    else if (keyword == "FIELD")
        readVtkField(file);
    else if (keyword == "METADATA")
        skipVtkMetadata(file.scanner);
    else
        file.scanner.fail("'" + printable(word) + "' stands where a section such as POINTS or CELLS should begin");
    return true;
}

}  // namespace

TetMeshFile readVtk(std::string_view bytes)
{
    VtkFile file{MeshScanner(bytes), {}, {}, MeshScanner(bytes), 0, false, false, false, 0, {}, {}, {}};
    MeshScanner& scanner = file.scanner;
    readHeader(file);
    if (vtkKeyword(scanner.word("DATASET")) != "DATASET") scanner.fail("here DATASET should be");
    const std::string_view dataset = scanner.word("UNSTRUCTURED_GRID");
    if (vtkKeyword(dataset) != "UNSTRUCTURED_GRID")
        scanner.fail("the dataset is '" + printable(dataset) + "'; tetrahedra are in an UNSTRUCTURED_GRID only");
    while (!scanner.atEnd() && readSection(file))
    {
    }
    if (!file.hasPoints) scanner.fail("the file has no section POINTS");
    if (!file.hasCells) scanner.fail("the file has no section CELLS");
    settleCellTypes(file);
    try
    {
        appendVtkCells(file.mesh, file.cells, 0);
    }
    catch (const std::runtime_error& error)
    {
        file.cellsPlace.fail(message("of CELLS, ", error.what()));
    }
    try
    {
        if (!file.data.empty()) findVtkRegions(file);
    }
    catch (const std::runtime_error&)  // a mesh needs no regions: errors after it are ignored
    {
    }
    noteVtkRegions(file.mesh, file.cells, file.regions);
    return std::move(file.mesh);
}

}  // namespace bullet_fem

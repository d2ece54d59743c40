// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "fem/common/message.h"
#include "io/tet/tet_readers.h"
#include "io/tet/vtk_cells.h"

namespace bullet_fem
{
namespace
{

struct VtkFile
{
    MeshScanner scanner;
    TetMeshFile mesh;
    VtkCells cells;
    MeshScanner cellsPlace;  // what is wrong with cells is known only when their types are
    int major = 0;           // of the version
    bool hasPoints = false, hasCells = false, hasTypes = false;
    std::string data;             // the keyword that ended the mesh: POINT_DATA or CELL_DATA
    std::vector<double> regions;  // of the cells, if an array tells them
};

/// A keyword, of which VTK ignores the case.
std::string upperCase(std::string_view word)
{
    std::string upper = printable(word);
    for (char& c : upper)
        if (c >= 'a' && c <= 'z') c = static_cast<char>(c - 'a' + 'A');
    return upper;
}

/// VTK's name of a type of numbers. long is what it is on 64-bit Unix; vtkIdType is written as int.
NumberType parseVtkType(const MeshScanner& scanner, std::string_view word)
{
    struct Named
    {
        const char* name;
        NumberType type;
    };
    static const Named types[] = {{"CHAR", {NumberType::signedInteger, 1}},
                                  {"SIGNED_CHAR", {NumberType::signedInteger, 1}},
                                  {"UNSIGNED_CHAR", {NumberType::unsignedInteger, 1}},
                                  {"SHORT", {NumberType::signedInteger, 2}},
                                  {"UNSIGNED_SHORT", {NumberType::unsignedInteger, 2}},
                                  {"INT", {NumberType::signedInteger, 4}},
                                  {"UNSIGNED_INT", {NumberType::unsignedInteger, 4}},
                                  {"LONG", {NumberType::signedInteger, 8}},
                                  {"UNSIGNED_LONG", {NumberType::unsignedInteger, 8}},
                                  {"VTKIDTYPE", {NumberType::signedInteger, 4}},
                                  {"VTKTYPEINT64", {NumberType::signedInteger, 8}},
                                  {"VTKTYPEUINT64", {NumberType::unsignedInteger, 8}},
                                  {"VTKTYPEINT32", {NumberType::signedInteger, 4}},
                                  {"VTKTYPEUINT32", {NumberType::unsignedInteger, 4}},
                                  {"FLOAT", {NumberType::floating, 4}},
                                  {"DOUBLE", {NumberType::floating, 8}}};
    const std::string name = upperCase(word);
    for (const Named& known : types)
        if (name == known.name) return known.type;
    scanner.fail("'" + printable(word) + "' is not a VTK number type");
}

/// `count` numbers of an array; the scanner stands behind the line that announces it.
template <class Number>
std::vector<Number> readNumbers(VtkFile& file, NumberType type, std::uint64_t count, const char* what)
{
    MeshScanner& scanner = file.scanner;
    scanner.need(count, 1, static_cast<std::uint64_t>(type.size), what);
    std::vector<Number> numbers;
    numbers.reserve(static_cast<std::size_t>(count));
    for (std::uint64_t i = 0; i < count; ++i)
    {
        if (!scanner.isBinary())
            numbers.push_back(scanner.text<Number>(what));
        else if constexpr (std::is_floating_point_v<Number>)
            numbers.push_back(doubleFromBits(scanner.bits(type.size, what), type));
        else
            numbers.push_back(integerFromBits(scanner.bits(type.size, what), type));
    }
    return numbers;
}

/// Integers of an array, whose type may be anything but floating.
std::vector<std::int64_t> readIntegers(VtkFile& file, NumberType type, std::uint64_t count, const char* what)
{
    if (type.kind == NumberType::floating) file.scanner.fail(message("the type of ", what, " is not an integer"));
    return readNumbers<std::int64_t>(file, type, count, what);
}

void readHeader(VtkFile& file)
{
    MeshScanner& scanner = file.scanner;
    constexpr std::string_view magic = "vtk DataFile Version ";
    std::string_view rest = scanner.restOfLine();
    const bool marked = rest.substr(0, 1) == "#";
    rest.remove_prefix(marked ? 1 : 0);
    if (rest.substr(0, 1) == " ") rest.remove_prefix(1);  // files of Bullet's own come without the blank
    if (!marked || rest.substr(0, magic.size()) != magic)
        scanner.fail("a VTK file begins with '# vtk DataFile Version'");
    rest.remove_prefix(magic.size());
    const std::string version = printable(takeWord(rest));
    file.major = scanner.parse<int>(std::string_view(version).substr(0, version.find('.')), "a version");
    if (file.major < 1 || file.major > 5) scanner.fail("the version is " + version + "; it must be in [1.0, 5.1]");
    scanner.restOfLine();  // the title
    const std::string encoding = upperCase(scanner.word("ASCII or BINARY"));
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
    const NumberType type = parseVtkType(scanner, scanner.word("a type of coordinates"));
    scanner.restOfLine();
    scanner.need(count, 1, 1, "points");
    const std::vector<double> x = readNumbers<double>(file, type, 3 * count, "a coordinate");
    for (std::uint64_t i = 0; i < count; ++i)
    {
        file.mesh.m_positions.push_back({x[3 * i], x[3 * i + 1], x[3 * i + 2]});
        file.mesh.m_nodeNumbers.push_back(i);
    }
}

/// Throws, with the place of a number of rows that begin there.
[[noreturn]] void failAtNumber(MeshScanner rows, std::uint64_t number, const std::string& cause)
{
    for (std::uint64_t i = 0; i <= number; ++i)
        if (rows.isBinary())
            rows.bits(4, "a cell's number");
        else
            rows.word("a cell's number");
    rows.fail(cause);
}

/// CELLS before version 5: for each cell the number of its corners, then these.
void readCellRows(VtkFile& file, std::uint64_t cellCount, std::uint64_t size)
{
    MeshScanner& scanner = file.scanner;
    const MeshScanner begin = scanner;
    const std::vector<std::int64_t> rows = readIntegers(file, {NumberType::signedInteger, 4}, size, "a cell's number");
    VtkCells& cells = file.cells;
    std::uint64_t next = 0;
    for (std::uint64_t c = 0; c < cellCount; ++c)
    {
        if (next >= size) scanner.fail(message("of ", cellCount, " CELLS only ", c, " are there"));
        const std::int64_t corners = rows[next++];
        if (corners < 0 || static_cast<std::uint64_t>(corners) > size - next)
            failAtNumber(begin, next - 1,
                         message("cell ", c, " has ", corners, " corners where ", size - next, " numbers are left"));
        cells.m_connectivity.insert(cells.m_connectivity.end(), rows.begin() + static_cast<std::ptrdiff_t>(next),
                                    rows.begin() + static_cast<std::ptrdiff_t>(next) + corners);
        cells.m_ends.push_back(static_cast<std::int64_t>(cells.m_connectivity.size()));
        next += static_cast<std::uint64_t>(corners);
    }
    if (next != size)
        failAtNumber(begin, next, message("CELLS of ", cellCount, " cells have ", next, " numbers, not ", size));
}

std::vector<std::int64_t> readNamedIntegers(VtkFile& file, const char* name, std::uint64_t count)
{
    MeshScanner& scanner = file.scanner;
    if (upperCase(scanner.word(name)) != name) scanner.fail(message("here ", name, " should be"));
    const NumberType type = parseVtkType(scanner, scanner.word("a type of integers"));
    scanner.restOfLine();
    return readIntegers(file, type, count, name);
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
    const auto size = scanner.text<std::uint64_t>("a number of integers");
    scanner.restOfLine();
    if (file.major < 5)
        readCellRows(file, count, size);
    else
        readCellArrays(file, count, size);
}

void readCellTypes(VtkFile& file)
{
    if (file.hasTypes) file.scanner.fail("there is a second section CELL_TYPES");
    file.hasTypes = true;
    const auto count = file.scanner.text<std::uint64_t>("a number of cell types");
    file.scanner.restOfLine();
    file.cells.m_types = readIntegers(file, {NumberType::signedInteger, 4}, count, "a cell type");
}

/// METADATA, which ends with an empty line or the file.
void skipMetadata(MeshScanner& scanner)
{
    scanner.restOfLine();
    while (scanner.left() > 0 && !scanner.restOfLine().empty())
    {
    }
}

/// Text in binary files: each behind a length, whose first two bits tell how many bytes that has.
void skipBinaryStrings(MeshScanner& scanner, std::uint64_t count)
{
    for (std::uint64_t i = 0; i < count; ++i)
    {
        if (scanner.left() == 0) scanner.skipBytes(1, "a string");
        const auto size = static_cast<std::size_t>(8 >> (static_cast<unsigned char>(*scanner.data()) >> 6));
        const std::uint64_t bits = scanner.left() < size ? 0 : readBits(scanner.data(), size, ByteOrder::big);
        scanner.skipBytes(size, "a string's length");
        scanner.skipBytes(bits & ((std::uint64_t{1} << (8 * size - 2)) - 1), "a string");
    }
}

/// `count` values of an array that is not needed.
void skipValues(MeshScanner& scanner, const std::string& type, std::uint64_t count)
{
    const bool strings = type == "STRING" || type == "UTF8_STRING";
    if (scanner.isBinary())
    {
        if (strings)
            skipBinaryStrings(scanner, count);
        else if (type == "BIT")
            scanner.skipBytes((count + 7) / 8, "bits");
        else
            scanner.skipBytes(count * static_cast<std::uint64_t>(parseVtkType(scanner, type).size), "an array");
    }
    else
        for (std::uint64_t i = 0; i < count; ++i)
        {
            if (strings)
                scanner.restOfLine();
            else
                scanner.word("a value");
        }
}

void skipField(MeshScanner& scanner)
{
    scanner.word("a field's name");
    const auto arrays = scanner.text<std::uint64_t>("a number of arrays");
    for (std::uint64_t a = 0; a < arrays; ++a)
    {
        if (upperCase(scanner.peekWord()) == "METADATA") skipMetadata(scanner);
        if (upperCase(scanner.word("an array's name")) == "NULL_ARRAY") continue;
        const auto components = scanner.text<std::uint64_t>("a number of components");
        const auto tuples = scanner.text<std::uint64_t>("a number of tuples");
        const std::string type = upperCase(scanner.word("an array's type"));
        scanner.restOfLine();
        const std::uint64_t most = 8 * std::uint64_t{scanner.left()};  // of bits
        if (components > 0 && tuples > most / components)
            scanner.fail(message("an array of ", tuples, " x ", components, " values in ", scanner.left(), " bytes"));
        skipValues(scanner, type, components * tuples);
    }
}

/// A section of the grid; returns false where its points' and cells' own arrays begin, which end the mesh.
bool readSection(VtkFile& file)
{
    const std::string keyword = upperCase(file.scanner.word("a section"));
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
        skipField(file.scanner);
    else if (keyword == "METADATA")
        skipMetadata(file.scanner);
    else
        file.scanner.fail("'" + keyword + "' stands where a section such as POINTS or CELLS should begin");
    return true;
}

/// The values of an array, kept if they are the cells' regions.
void readDataArray(VtkFile& file, const std::string& name, const std::string& type, std::uint64_t components,
                   std::uint64_t tuples)
{
    const std::uint64_t most = 8 * std::uint64_t{file.scanner.left()};  // of bits
    if (components > 0 && tuples > most / components) file.scanner.fail("an array is too long");
    const bool areRegions = file.data == "CELL_DATA" && components == 1 && isVtkRegionName(name);
    if (!areRegions || type == "STRING" || type == "BIT") return skipValues(file.scanner, type, components * tuples);
    file.regions = readNumbers<double>(file, parseVtkType(file.scanner, type), tuples, "a region");
}

/// SCALARS and FIELD arrays of points and cells, up to the first thing of another kind.
void findRegions(VtkFile& file)
{
    MeshScanner& scanner = file.scanner;
    auto count = scanner.text<std::uint64_t>("a number of values");
    while (!scanner.atEnd())
    {
        const std::string keyword = upperCase(scanner.word("an array"));
        if (keyword == "POINT_DATA" || keyword == "CELL_DATA")
        {
            file.data = keyword;
            count = scanner.text<std::uint64_t>("a number of values");
        }
        else if (keyword == "SCALARS")
        {
            const std::string name = printable(scanner.word("an array's name"));
            const std::string type = upperCase(scanner.word("an array's type"));
            std::string_view rest = scanner.restOfLine();
            const std::string_view components = takeWord(rest);
            scanner.word("LOOKUP_TABLE");
            scanner.restOfLine();
            const auto each = components.empty() ? 1 : scanner.parse<std::uint64_t>(components, "components");
            readDataArray(file, name, type, each, count);
        }
        else if (keyword == "FIELD")
        {
            scanner.word("a field's name");
            const auto arrays = scanner.text<std::uint64_t>("a number of arrays");
            for (std::uint64_t a = 0; a < arrays; ++a)
            {
                if (upperCase(scanner.peekWord()) == "METADATA") skipMetadata(scanner);
                const std::string name = printable(scanner.word("an array's name"));
                const auto components = scanner.text<std::uint64_t>("a number of components");
                const auto tuples = scanner.text<std::uint64_t>("a number of tuples");
                const std::string type = upperCase(scanner.word("an array's type"));
                scanner.restOfLine();
                readDataArray(file, name, type, components, tuples);
            }
        }
        else if (keyword == "METADATA")
            skipMetadata(scanner);
        else
            return;
    }
}

}  // namespace

TetMeshFile readVtk(std::string_view bytes)
{
    VtkFile file{MeshScanner(bytes), {}, {}, MeshScanner(bytes), 0, false, false, false, {}, {}};
    MeshScanner& scanner = file.scanner;
    readHeader(file);
    if (upperCase(scanner.word("DATASET")) != "DATASET") scanner.fail("here DATASET should be");
    const std::string dataset(upperCase(scanner.word("UNSTRUCTURED_GRID")));
    if (dataset != "UNSTRUCTURED_GRID")
        scanner.fail("the dataset is '" + dataset + "'; tetrahedra are in an UNSTRUCTURED_GRID only");
    while (!scanner.atEnd() && readSection(file))
    {
    }
    if (!file.hasPoints) scanner.fail("the file has no section POINTS");
    if (!file.hasCells) scanner.fail("the file has no section CELLS");
    if (!file.hasTypes) scanner.fail("the file has no section CELL_TYPES");
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
        if (!file.data.empty()) findRegions(file);
    }
    catch (const std::runtime_error&)  // a mesh needs no regions: what follows it was never looked at
    {
    }
    noteVtkRegions(file.mesh, file.cells, file.regions);
    return std::move(file.mesh);
}

}  // namespace bullet_fem

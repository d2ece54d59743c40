// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "fem/common/message.h"
#include "io/tet/vtk_file.h"

namespace bullet_fem
{
namespace
{

template <class Number>
std::vector<Number> readVtkNumbers(VtkFile& file, NumberType type, std::uint64_t count, const char* what)
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

/// Strings in binary files: each after a length, whose first two bits give the size of that length.
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

/// Skips `count` values of an array.
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
            scanner.skipBytes(count * static_cast<std::uint64_t>(vtkNumberType(scanner, type).size), "an array");
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

/// Reads the values of an array, and keeps them if they are the cells' regions.
void readDataArray(VtkFile& file, const std::string& name, const std::string& type, std::uint64_t components,
                   std::uint64_t tuples)
{
    MeshScanner& scanner = file.scanner;
    const std::uint64_t most = 8 * std::uint64_t{scanner.left()};  // of bits
    if (components > 0 && tuples > most / components)
        scanner.fail(message("an array of ", tuples, " x ", components, " values in ", scanner.left(), " bytes"));
    const bool areRegions = file.data == "CELL_DATA" && components == 1 && isVtkRegionName(name);
    if (!areRegions || type == "STRING" || type == "BIT") return skipValues(scanner, type, components * tuples);
    file.regions = readVtkDoubles(file, vtkNumberType(scanner, type), tuples, "a region");
}

}  // namespace

std::string vtkKeyword(std::string_view word)
{
    std::string upper = printable(word);
    for (char& c : upper)
        if (c >= 'a' && c <= 'z') c = static_cast<char>(c - 'a' + 'A');
    return upper;
}

NumberType vtkNumberType(const MeshScanner& scanner, std::string_view word)
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
    const std::string name = vtkKeyword(word);
    for (const Named& known : types)
        if (name == known.name) return known.type;
    scanner.fail("'" + printable(word) + "' is not a VTK number type");
}

std::vector<double> readVtkDoubles(VtkFile& file, NumberType type, std::uint64_t count, const char* what)
{
    return readVtkNumbers<double>(file, type, count, what);
}

std::vector<std::int64_t> readVtkIntegers(VtkFile& file, NumberType type, std::uint64_t count, const char* what)
{
    if (type.kind == NumberType::floating) file.scanner.fail(message("the type of ", what, " is not an integer"));
    return readVtkNumbers<std::int64_t>(file, type, count, what);
}

void skipVtkMetadata(MeshScanner& scanner)
{
    scanner.restOfLine();
    while (scanner.left() > 0 && !scanner.restOfLine().empty())
    {
    }
}

void readVtkField(VtkFile& file)
{
    MeshScanner& scanner = file.scanner;
    scanner.word("a field's name");
    const auto arrays = scanner.text<std::uint64_t>("a number of arrays");
    for (std::uint64_t a = 0; a < arrays; ++a)
    {
        if (vtkKeyword(scanner.peekWord()) == "METADATA") skipVtkMetadata(scanner);
        const std::string name = printable(scanner.word("an array's name"));
        if (vtkKeyword(name) == "NULL_ARRAY") continue;
        const auto components = scanner.text<std::uint64_t>("a number of components");
        const auto tuples = scanner.text<std::uint64_t>("a number of tuples");
        const std::string type = vtkKeyword(scanner.word("an array's type"));
        scanner.restOfLine();
        readDataArray(file, name, type, components, tuples);
    }
}

void findVtkRegions(VtkFile& file)
{
    MeshScanner& scanner = file.scanner;
    auto count = scanner.text<std::uint64_t>("a number of values");
    while (!scanner.atEnd())
    {
        const std::string keyword = vtkKeyword(scanner.word("an array"));
        if (keyword == "POINT_DATA" || keyword == "CELL_DATA")
        {
            file.data = keyword;
            count = scanner.text<std::uint64_t>("a number of values");
        }
        else if (keyword == "SCALARS")
        {
            const std::string name = printable(scanner.word("an array's name"));
            const std::string type = vtkKeyword(scanner.word("an array's type"));
            std::string_view rest = scanner.restOfLine();
            const std::string_view components = takeWord(rest);
            scanner.word("LOOKUP_TABLE");
            scanner.restOfLine();
            const auto each = components.empty() ? 1 : scanner.parse<std::uint64_t>(components, "components");
            readDataArray(file, name, type, each, count);
        }
        else if (keyword == "FIELD")
            readVtkField(file);
        else if (keyword == "METADATA")
            skipVtkMetadata(scanner);
        else
            return;
    }
}

}  // namespace bullet_fem

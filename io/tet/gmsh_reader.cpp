// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include <stdexcept>

#include "fem/common/message.h"
#include "io/tet/gmsh_sections.h"
#include "io/tet/tet_readers.h"

namespace bullet_fem
{
namespace
{

/// The byte order in which these four bytes are the integer 1.
ByteOrder readByteOrder(MeshScanner& scanner)
{
    if (scanner.left() >= 4)
        for (const ByteOrder order : {ByteOrder::little, ByteOrder::big})
            if (readBits(scanner.data(), 4, order) == 1) return order;
    scanner.setBinary(ByteOrder::little);
    scanner.bits(4, "the number 1 that tells the byte order");
    scanner.fail("the number that tells the byte order is not 1");
}

[[noreturn]] void failVersion(const MeshScanner& scanner, const std::string& version)
{
    scanner.fail("MSH version " + version + " cannot be read, only 1 ($NOD), 2.0 to 2.2 and 4.1; convert it: " +
                 "gmsh OLD.msh -save -format msh41 -o NEW.msh");
}

/// Reads $MeshFormat; returns the version's first digit.
int readFormat(GmshFile& file)
{
    MeshScanner& scanner = file.scanner;
    const std::string version = printable(scanner.word("a version"));
    const bool is2 = version == "2" || version == "2.0" || version == "2.1" || version == "2.2";
    if (!is2 && version != "4.1") failVersion(scanner, version);
    const int type = scanner.text<int>("the file type, 0 or 1");
    if (type != 0 && type != 1) scanner.fail(message("the file type is ", type, "; it must be 0 (text) or 1 (binary)"));
    file.sizeBytes = scanner.text<int>("a data size");
    if (file.sizeBytes != 8 && (is2 || file.sizeBytes != 4))
        scanner.fail(message("the data size is ", file.sizeBytes, "; it must be 8", is2 ? "" : " or 4"));
    scanner.restOfLine();
    if (type == 1)
    {
        const ByteOrder order = readByteOrder(scanner);
        scanner.setBinary(order);
        scanner.skipBytes(4, "the byte order");
    }
    file.mesh.m_format = "Gmsh";
    file.mesh.m_version = version + (type == 1 ? " binary" : " text");
    return is2 ? 2 : 4;
}

/// The closing line of a section.
std::string endOf(const std::string& section, int version)
{
    return (version == 1 ? "$END" : "$End") + section;
}

/// Skips the closing line of a section that was read.
void readEnd(MeshScanner& scanner, const std::string& end)
{
    const std::string_view word = scanner.word(end.c_str());
    if (word != end) scanner.fail("'" + printable(word) + "' stands where " + end + " should be");
}

bool isNodeSection(const std::string& section, int version)
{
    return version == 1 ? section == "NOD" || section == "NOE" : section == "Nodes";
}

bool isElementSection(const std::string& section, int version)
{
    return section == (version == 1 ? "ELM" : "Elements");
}

void readNodes(GmshFile& file, int version)
{
    if (file.numbers) file.scanner.fail("there is a second section of nodes");
    version == 4 ? readGmshNodes4(file) : readGmshNodes2(file);
    file.numbers = std::make_unique<NodeNumbers>(file.mesh.m_nodeNumbers, file.scanner);
}

void readElements(GmshFile& file, int version)
{
    if (!file.numbers) file.scanner.fail(version == 1 ? "$ELM stands before $NOD" : "$Elements stands before $Nodes");
    version == 1 ? readGmshElements1(file) : version == 2 ? readGmshElements2(file) : readGmshElements4(file);
}

/// Version 1 has no $MeshFormat: its files begin with nodes or elements.
int versionWithoutFormat(GmshFile& file, std::string_view word)
{
    if (word != "$NOD" && word != "$NOE" && word != "$ELM") return 0;
    file.mesh.m_format = "Gmsh";
    file.mesh.m_version = "1 text";
    return 1;
}

// Skips the section: a mesh needs no group names.
void findGroups(GmshFile& file)
{
    const MeshScanner before = file.scanner;
    try
    {
        file.scanner.restOfLine();
        readGmshEntities4(file);
    }
    catch (const std::runtime_error&)
    {
        file.groups.clear();
    }
    file.scanner = before;
}

}  // namespace

TetMeshFile readGmsh(std::string_view bytes)
{
    GmshFile file{MeshScanner(bytes), {}, 8, {}, {}};
    MeshScanner& scanner = file.scanner;
    int version = 0;
    while (!scanner.atEnd())
    {
        const std::string_view word = scanner.word("a section");
        if (version == 0) version = versionWithoutFormat(file, word);
        if (word.size() < 2 || word[0] != '$' || (version == 0 && word != "$MeshFormat" && word != "$Comments"))
            scanner.fail("'" + printable(word) + "' stands where a section such as " +
                         (version == 0 ? "$MeshFormat" : "$Nodes") + " should begin");
        const std::string section(word.substr(1));
        const bool isFormat = section == "MeshFormat", isNodes = isNodeSection(section, version),
                   isElements = isElementSection(section, version);
        if (section == "Entities" && version == 4) findGroups(file);
        if (!isFormat && !isNodes && !isElements)
        {
            if (!scanner.skipPast(endOf(section.substr(0, 200), version)))
                scanner.fail("the section $" + printable(section) + " has no end");
            continue;
        }
        scanner.restOfLine();
        if (isFormat && version != 0) scanner.fail("a section $MeshFormat must come first, and only once");
        if (isFormat)
            version = readFormat(file);
        else if (isNodes)
            readNodes(file, version);
        else
            readElements(file, version);
        readEnd(scanner, endOf(section, version));
    }
    if (!file.numbers) scanner.fail("the file has no section $Nodes");
    return std::move(file.mesh);
}

}  // namespace bullet_fem

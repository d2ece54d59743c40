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

/// The byte order in which four bytes are a 1.
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
    scanner.fail("MSH version " + version + " cannot be read, only 2.0 to 2.2 and 4.1; convert it: " +
                 "gmsh OLD.msh -save -format msh41 -o NEW.msh");
}

/// The content of $MeshFormat; returns the version's first digit.
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

/// Passes the closing line of a section that was read.
void readEnd(MeshScanner& scanner, const std::string& section)
{
    const std::string end = "$End" + section;
    const std::string_view word = scanner.word(end.c_str());
    if (word != end) scanner.fail("'" + printable(word) + "' stands where " + end + " should be");
}

void readNodes(GmshFile& file, int version)
{
    if (file.numbers) file.scanner.fail("there is a second section $Nodes");
    version == 2 ? readGmshNodes2(file) : readGmshNodes4(file);
    file.numbers = std::make_unique<NodeNumbers>(file.mesh.m_nodeNumbers, file.scanner);
}

void readElements(GmshFile& file, int version)
{
    if (!file.numbers) file.scanner.fail("$Elements stands before $Nodes");
    version == 2 ? readGmshElements2(file) : readGmshElements4(file);
}

// The section itself is passed with those that are not read: a mesh needs no groups.
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
        if (version == 0 && word == "$NOD") failVersion(scanner, "1");
        if (word.size() < 2 || word[0] != '$' || (version == 0 && word != "$MeshFormat" && word != "$Comments"))
            scanner.fail("'" + printable(word) + "' stands where a section such as " +
                         (version == 0 ? "$MeshFormat" : "$Nodes") + " should begin");
        const std::string section(word.substr(1));
        const bool isFormat = section == "MeshFormat", isNodes = section == "Nodes", isElements = section == "Elements";
        if (section == "Entities" && version == 4) findGroups(file);
        if (!isFormat && !isNodes && !isElements)
        {
            if (!scanner.skipPast("$End" + section.substr(0, 200)))
                scanner.fail("the section $" + printable(section) + " has no end");
            continue;
        }
        scanner.restOfLine();
        if (isFormat && version != 0) scanner.fail("there is a second section $MeshFormat");
        if (isFormat)
            version = readFormat(file);
        else if (isNodes)
            readNodes(file, version);
        else
            readElements(file, version);
        readEnd(scanner, section);
    }
    if (!file.numbers) scanner.fail("the file has no section $Nodes");
    return std::move(file.mesh);
}

}  // namespace bullet_fem

// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "io/text/foreign_file.h"

#include <algorithm>
#include <stdexcept>
#include <string>

#include "fem/common/message.h"
#include "io/text/binary_number.h"

namespace bullet_fem
{
namespace
{

using namespace std::string_view_literals;

struct Signature
{
    std::string_view m_bytes;  // first bytes of the file
    const char* m_name;        // with its article
    const char* m_remedy;      // empty: save it in another format
};

constexpr Signature kSignatures[] = {{"\x1f\x8b"sv, "a gzip archive", "unpack it first"},
                                     {"PK\3\4"sv, "a ZIP archive", "unpack it first"},
                                     {"BZh"sv, "a bzip2 archive", "unpack it first"},
                                     {"\xfd"
                                      "7zXZ\0"sv,
                                      "an xz archive", "unpack it first"},
                                     {"\x28\xb5\x2f\xfd"sv, "a Zstandard archive", "unpack it first"},
                                     {"\xff\xfe"sv, "text in UTF-16", "save it as UTF-8 or ASCII"},
                                     {"\xfe\xff"sv, "text in UTF-16", "save it as UTF-8 or ASCII"},
                                     {"BFEMBODY"sv, "a baked body of BulletFEM", "give it the ending .bfem"},
                                     {"\x89HDF\r\n"sv, "an HDF5 file, such as MED, XDMF or CGNS", ""},
                                     {"CDF\1"sv, "a NetCDF file, such as Exodus", ""},
                                     {"CDF\2"sv, "a NetCDF file, such as Exodus", ""},
                                     {"glTF"sv, "a binary glTF file", ""},
                                     {"Kaydara FBX"sv, "an FBX file", ""},
                                     {"BLENDER"sv, "a Blender file", ""},
                                     {"\x89PNG"sv, "a PNG picture", ""},
                                     {"\xff\xd8\xff"sv, "a JPEG picture", ""},
                                     {"%PDF"sv, "a PDF document", ""},
                                     {"\x7f"
                                      "ELF"sv,
                                      "a program", ""}};

bool beginsWith(std::string_view bytes, std::string_view with)
{
    return bytes.substr(0, with.size()) == with;
}

/// The number 1, which shows the byte order, and a version, both of four bytes.
bool isBinaryMedit(std::string_view bytes)
{
    if (bytes.size() < 8) return false;
    for (const ByteOrder order : {ByteOrder::little, ByteOrder::big})
        if (const std::uint64_t version = readBits(bytes.data() + 4, 4, order); readBits(bytes.data(), 4, order) == 1)
            return version >= 1 && version <= 4;
    return false;
}

/// Supported binary files begin with text.
bool beginsAsKnown(std::string_view bytes)
{
    const std::size_t first = bytes.find_first_not_of(" \t\r\n");
    if (first == std::string_view::npos) return true;
    bytes.remove_prefix(first);
    return bytes[0] == '$' || bytes[0] == '#' || bytes[0] == '<' || beginsWith(bytes, "ply");
}

/// No text has control characters except white space.
bool isControl(char c)
{
    return (c >= 0 && c < ' ' && !(c >= '\t' && c <= '\r')) || c == 127;
}

}  // namespace

void refuseForeignFile(std::string_view bytes, const char* endings)
{
    bytes = bytes.substr(0, kHeadBytes);
    for (const Signature& known : kSignatures)
        if (beginsWith(bytes, known.m_bytes))
            throw std::runtime_error(message("byte 0: it is ", known.m_name, ", which is not read; ",
                                             *known.m_remedy ? known.m_remedy : "save the mesh as ",
                                             *known.m_remedy ? "" : endings));
    if (isBinaryMedit(bytes))
        throw std::runtime_error(
            "byte 0: it is a binary Medit file (.meshb), which is not read; save it as text (.mesh)");
    const auto control = std::find_if(bytes.begin(), bytes.end(), isControl);
    if (control != bytes.end() && !beginsAsKnown(bytes))
        throw std::runtime_error(message("byte ", control - bytes.begin(),
                                         ": it is a binary file, and of no format that is read; save the mesh as ",
                                         endings));
}

}  // namespace bullet_fem

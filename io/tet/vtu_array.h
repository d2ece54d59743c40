// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "io/text/binary_number.h"

namespace tinyxml2
{
class XMLElement;
}

namespace bullet_fem
{

/// Encoding of the arrays of a .vtu file.
struct VtuArrayEncoding
{
    ByteOrder order = ByteOrder::little;
    int headerBytes = 4;            ///< size of the counts before binary data
    bool compressed = false;        ///< by zlib
    std::string_view appended;      ///< contents after the underscore in <AppendedData>
    bool appendedBase64 = false;    ///< base64, not raw
    std::uint64_t numbersLeft = 0;  ///< numbers that may still be decoded
};

/// An attribute's value, shortened and printable, or `otherwise` if the element does not have it.
std::string vtuAttribute(const tinyxml2::XMLElement& element, const char* name, const char* otherwise = "");

/// The numbers of a <DataArray>. Throws std::runtime_error with the element's line.
std::vector<double> readVtuDoubles(const tinyxml2::XMLElement& array, VtuArrayEncoding& encoding);
std::vector<std::int64_t> readVtuIntegers(const tinyxml2::XMLElement& array, VtuArrayEncoding& encoding);

}  // namespace bullet_fem

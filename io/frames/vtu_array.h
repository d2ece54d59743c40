// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "bullet_fem/io/vtu_writer.h"

namespace bullet_fem
{

/// Attributes of a DataArray element of VTK's XML formats.
struct VtuArray
{
    const char* m_name;
    int m_components = 0;                       ///< values per tuple; 0: one, without the attribute
    std::vector<const char*> m_componentNames;  ///< may be empty
    bool m_exact = false;                       ///< text with enough digits for an exact round trip
};

/// Appends a DataArray of numbers to `xml`. Binary arrays are of single precision, text has nine digits of double.
void appendArray(std::string& xml, VtuEncoding encoding, const VtuArray& array, const std::vector<double>& values);
/// Appends a DataArray of integers to `xml`.
void appendArray(std::string& xml, VtuEncoding encoding, const VtuArray& array,
                 const std::vector<std::int32_t>& values);
void appendArray(std::string& xml, VtuEncoding encoding, const VtuArray& array,
                 const std::vector<std::uint8_t>& values);

/// The attributes of a VTKFile element that say how its arrays are encoded: with a space in front, or nothing.
std::string encodingAttributes(VtuEncoding encoding);

}  // namespace bullet_fem

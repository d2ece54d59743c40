// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "bullet_fem/io/vtu_writer.h"

namespace bullet_fem
{

/// What a DataArray element of VTK's XML formats says of itself.
struct VtuArray
{
    const char* m_name;
    int m_components = 0;                       ///< values a tuple; 0: one, and not said
    std::vector<const char*> m_componentNames;  ///< may be empty
    bool m_exact = false;                       ///< text: as many digits as give back the same bits
};

/// Appends a DataArray of numbers to `xml`. Binary arrays are of single precision, text has nine digits of double.
void appendArray(std::string& xml, VtuEncoding encoding, const VtuArray& array, const std::vector<double>& values);
/// The same for whole numbers.
void appendArray(std::string& xml, VtuEncoding encoding, const VtuArray& array,
                 const std::vector<std::int32_t>& values);
void appendArray(std::string& xml, VtuEncoding encoding, const VtuArray& array,
                 const std::vector<std::uint8_t>& values);

/// The attributes of a VTKFile element that say how its arrays are encoded: with a space in front, or nothing.
std::string encodingAttributes(VtuEncoding encoding);

}  // namespace bullet_fem

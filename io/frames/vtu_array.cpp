// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// Array encodings of VTK's XML formats: text, or base 64 with a header of 64-bit counts, in the machine's byte order.
// Compressed arrays are divided into blocks, each compressed separately, and have a separately encoded header: [blocks,
// bytes of a block, bytes of the last one if it is shorter, compressed bytes of each].
#include "io/frames/vtu_array.h"

#include <zlib.h>

#include <algorithm>
#include <cstring>
#include <stdexcept>
#include <string_view>

#include "io/text/written_number.h"

namespace bullet_fem
{
namespace
{

constexpr std::size_t kBlock = 1 << 18;  // bytes compressed at a time
constexpr std::size_t kPerLine = 12;     // single values in a line of text
constexpr int kLevel = 6;                // zlib's usual compromise

template <class Number>
constexpr const char* typeName()
{
    if constexpr (std::is_same_v<Number, float>) return "Float32";
    if constexpr (std::is_same_v<Number, double>) return "Float64";
    if constexpr (std::is_same_v<Number, std::uint8_t>) return "UInt8";
    if constexpr (std::is_same_v<Number, std::int32_t>) return "Int32";
}

template <class Number>
std::string_view bytesOf(const std::vector<Number>& values)
{
    return {reinterpret_cast<const char*>(values.data()), values.size() * sizeof(Number)};
}

void appendBase64(std::string& out, std::string_view bytes)
{
    constexpr const char* digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    out.reserve(out.size() + (bytes.size() + 2) / 3 * 4);
    for (std::size_t i = 0; i < bytes.size(); i += 3)
    {
        const std::size_t count = std::min<std::size_t>(3, bytes.size() - i);
        std::uint32_t triple = 0;
        for (std::size_t k = 0; k < 3; ++k)
            triple = triple << 8 | (k < count ? static_cast<unsigned char>(bytes[i + k]) : 0u);
        for (std::size_t k = 0; k < 4; ++k) out += k <= count ? digits[triple >> (18 - 6 * k) & 63] : '=';
    }
}

void appendBinary(std::string& xml, std::string_view bytes)
{
    const std::uint64_t size = bytes.size();
    std::string whole(reinterpret_cast<const char*>(&size), sizeof size);
    whole += bytes;
    appendBase64(xml, whole);
}

void appendCompressed(std::string& xml, std::string_view bytes)
{
    std::vector<std::uint64_t> header = {(bytes.size() + kBlock - 1) / kBlock, kBlock, bytes.size() % kBlock};
    std::string packed;
    for (std::size_t begin = 0; begin < bytes.size(); begin += kBlock)
    {
        const std::string_view block = bytes.substr(begin, kBlock);
        uLongf size = compressBound(static_cast<uLong>(block.size()));
        const std::size_t end = packed.size();
        packed.resize(end + size);
        if (compress2(reinterpret_cast<Bytef*>(&packed[end]), &size, reinterpret_cast<const Bytef*>(block.data()),
                      static_cast<uLong>(block.size()), kLevel) != Z_OK)
            throw std::runtime_error("zlib could not compress an array");
        packed.resize(end + size);
        header.push_back(size);
    }
    appendBase64(xml, bytesOf(header));
    appendBase64(xml, packed);
}

template <class Number>
void appendText(std::string& xml, const VtuArray& array, const std::vector<Number>& values)
{
    const std::size_t perLine = array.m_components > 1 ? static_cast<std::size_t>(array.m_components) : kPerLine;
    for (std::size_t i = 0; i < values.size(); ++i)
    {
        if constexpr (std::is_same_v<Number, double>)
            xml += array.m_exact ? exactNumber(values[i]) : writtenNumber(values[i]);
        else
            xml += std::to_string(values[i]);
        xml += (i + 1) % perLine == 0 || i + 1 == values.size() ? '\n' : ' ';
    }
}

template <class Number>
void append(std::string& xml, VtuEncoding encoding, const VtuArray& array, const std::vector<Number>& values)
{
    xml += std::string("<DataArray type=\"") + typeName<Number>() + "\" Name=\"" + array.m_name + "\"";
    if (array.m_components > 0) xml += " NumberOfComponents=\"" + std::to_string(array.m_components) + "\"";
    for (std::size_t k = 0; k < array.m_componentNames.size(); ++k)
        xml += " ComponentName" + std::to_string(k) + "=\"" + array.m_componentNames[k] + "\"";
    xml += encoding == VtuEncoding::text ? " format=\"ascii\">\n" : " format=\"binary\">\n";
    if (encoding == VtuEncoding::text)
        appendText(xml, array, values);
    else if (encoding == VtuEncoding::binary)
        appendBinary(xml, bytesOf(values));
    else
        appendCompressed(xml, bytesOf(values));
    xml += encoding == VtuEncoding::text ? "</DataArray>\n" : "\n</DataArray>\n";
}

}  // namespace

void appendArray(std::string& xml, VtuEncoding encoding, const VtuArray& array, const std::vector<double>& values)
{
    if (encoding == VtuEncoding::text)
        append(xml, encoding, array, values);
    else
        append(xml, encoding, array, std::vector<float>(values.begin(), values.end()));
}

void appendArray(std::string& xml, VtuEncoding encoding, const VtuArray& array, const std::vector<std::int32_t>& values)
{
    append(xml, encoding, array, values);
}

void appendArray(std::string& xml, VtuEncoding encoding, const VtuArray& array, const std::vector<std::uint8_t>& values)
{
    append(xml, encoding, array, values);
}

std::string encodingAttributes(VtuEncoding encoding)
{
    if (encoding == VtuEncoding::text) return {};
    const std::uint16_t one = 1;
    char first;
    std::memcpy(&first, &one, 1);
    std::string attributes = " byte_order=\"";
    attributes += first == 1 ? "LittleEndian" : "BigEndian";
    attributes += "\" header_type=\"UInt64\"";
    if (encoding == VtuEncoding::compressed) attributes += " compressor=\"vtkZLibDataCompressor\"";
    return attributes;
}

}  // namespace bullet_fem

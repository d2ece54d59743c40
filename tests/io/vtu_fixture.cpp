// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include <zlib.h>

#include <cstdint>
#include <stdexcept>

#include "io/byte_text.h"
#include "io/tet_fixtures.h"

namespace bullet_fem
{
namespace
{

std::string base64(const std::string& bytes)
{
    constexpr const char* digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text;
    for (std::size_t i = 0; i < bytes.size(); i += 3)
    {
        std::uint32_t bits = 0;
        for (std::size_t k = i; k < i + 3; ++k)
            bits = bits << 8 | (k < bytes.size() ? static_cast<unsigned char>(bytes[k]) : 0u);
        for (std::size_t k = 0; k < 4; ++k) text += i + k > bytes.size() ? '=' : digits[bits >> (18 - 6 * k) & 63];
    }
    return text;
}

// Deflates with the smallest tables: clearing the default ones would take most of the test's time.
std::string deflated(const std::string& bytes)
{
    constexpr int kWindowBits = 15, kMemoryLevel = 1;
    z_stream stream = {};
    if (deflateInit2(&stream, Z_DEFAULT_COMPRESSION, Z_DEFLATED, kWindowBits, kMemoryLevel, Z_DEFAULT_STRATEGY) != Z_OK)
        throw std::logic_error("zlib failed");
    std::string out(deflateBound(&stream, bytes.size()), '\0');
    stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(bytes.data()));
    stream.avail_in = static_cast<uInt>(bytes.size());
    stream.next_out = reinterpret_cast<Bytef*>(out.data());
    stream.avail_out = static_cast<uInt>(out.size());
    const int result = deflate(&stream, Z_FINISH);
    out.resize(stream.total_out);
    deflateEnd(&stream);
    if (result != Z_STREAM_END) throw std::logic_error("zlib failed");
    return out;
}

void appendCount(ByteText& file, std::size_t count, const VtuLayout& layout)
{
    if (layout.headerBytes == 8)
        file.raw(static_cast<std::uint64_t>(count));
    else
        file.raw(static_cast<std::uint32_t>(count));
}

/// An array as encoded in the file.
std::string encoded(const std::string& bytes, const VtuLayout& layout)
{
    ByteText header(layout.bigEndian);
    std::string body = bytes;
    if (layout.blockBytes == 0)
        appendCount(header, bytes.size(), layout);
    else
    {
        const std::size_t rest = bytes.size() % layout.blockBytes;
        appendCount(header, (bytes.size() + layout.blockBytes - 1) / layout.blockBytes, layout);
        appendCount(header, layout.blockBytes, layout);
        appendCount(header, rest, layout);
        body.clear();
        for (std::size_t at = 0; at < bytes.size(); at += layout.blockBytes)
        {
            const std::string block = deflated(bytes.substr(at, layout.blockBytes));
            appendCount(header, block.size(), layout);
            body += block;
        }
    }
    if (layout.format == std::string("raw")) return header.bytes() + body;
    const bool apart = layout.paddedHeader || layout.blockBytes > 0;
    return apart ? base64(header.bytes()) + base64(body) : base64(header.bytes() + body);
}

template <class Number>
void appendNumber(ByteText& file, const std::string& type, Number value)
{
    if (type == "Float32") file.raw(static_cast<float>(value));
    if (type == "Float64") file.raw(static_cast<double>(value));
    if (type == "UInt8") file.raw(static_cast<std::uint8_t>(value));
    if (type == "Int16") file.raw(static_cast<std::int16_t>(value));
    if (type == "Int32" || type == "UInt32") file.raw(static_cast<std::int32_t>(value));
    if (type == "Int64") file.raw(static_cast<std::int64_t>(value));
}

}  // namespace

std::string vtuBinary(const VtuLayout& layout)
{
    const bool isInline = layout.format == std::string("binary");
    ByteText file, appended;
    file << "<?xml version=\"1.0\"?>\n<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\""
         << (layout.bigEndian ? "BigEndian" : "LittleEndian") << "\" header_type=\"UInt" << 8 * layout.headerBytes
         << (layout.blockBytes > 0 ? "\" compressor=\"vtkZLibDataCompressor" : "") << "\">\n<UnstructuredGrid>\n"
         << "<Piece NumberOfPoints=\"6\" NumberOfCells=\"5\">\n";
    const auto array = [&](const std::string& attributes, const std::string& type, const std::vector<double>& numbers)
    {
        ByteText bytes(layout.bigEndian);
        for (const double number : numbers) appendNumber(bytes, type, number);
        file << "<DataArray type=\"" << type << "\" " << attributes;
        if (isInline)
            file << " format=\"binary\">\n  " << encoded(bytes.bytes(), layout) << "\n";
        else
            file << " format=\"appended\" offset=\"" << appended.bytes().size() << "\">";
        if (!isInline) appended << encoded(bytes.bytes(), layout);
        file << "</DataArray>\n";
    };
    std::vector<double> x;
    for (const Vec3& node : fixtureNodes()) x.insert(x.end(), {node.x, node.y, node.z});
    file << "<Points>\n";
    array("NumberOfComponents=\"3\"", layout.real, x);
    file << "</Points>\n<Cells>\n";
    array("Name=\"connectivity\"", layout.integer, {0, 0, 1, 0, 1, 3, 0, 1, 2, 4, 1, 2, 4, 5});
    array("Name=\"offsets\"", layout.integer, {1, 3, 6, 10, 14});
    array("Name=\"types\"", "UInt8", {1, 3, 5, 10, 10});
    file << "</Cells>\n</Piece>\n</UnstructuredGrid>\n";
    if (!isInline)
        file << "<AppendedData encoding=\"" << layout.format << "\">\n  _" << appended.bytes()
             << "\n  </AppendedData>\n";
    file << "</VTKFile>\n";
    return file.bytes();
}

}  // namespace bullet_fem

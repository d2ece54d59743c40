// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors

// Assimp 5.2's own PLY reader never returns from a header that is cut short, invents faces when the file is, and
// allocates what the header claims: hence this one.
#include <algorithm>
#include <array>
#include <climits>
#include <cmath>
#include <cstdint>

#include "fem/common/message.h"
#include "io/surface/polygon_mesh.h"
#include "io/text/binary_number.h"
#include "io/text/number_text.h"

namespace bullet_fem
{
namespace
{

enum class Encoding
{
    text,
    littleEndian,
    bigEndian
};

struct Property
{
    std::string name;
    NumberType type;
    bool isList = false;
    NumberType countType{};
};

struct Element
{
    std::string name;
    std::int64_t count = 0;
    std::vector<Property> properties;
};

struct Header
{
    Encoding encoding = Encoding::text;
    std::vector<Element> elements;
};

NumberType parseType(std::string_view word)
{
    struct Named
    {
        const char *name, *alias;
        NumberType type;
    };
    static const Named types[] = {
        {"char", "int8", {NumberType::signedInteger, 1}},   {"uchar", "uint8", {NumberType::unsignedInteger, 1}},
        {"short", "int16", {NumberType::signedInteger, 2}}, {"ushort", "uint16", {NumberType::unsignedInteger, 2}},
        {"int", "int32", {NumberType::signedInteger, 4}},   {"uint", "uint32", {NumberType::unsignedInteger, 4}},
        {"float", "float32", {NumberType::floating, 4}},    {"double", "float64", {NumberType::floating, 8}}};
    for (const Named& t : types)
        if (word == t.name || word == t.alias) return t.type;
    throw std::runtime_error("'" + printable(word) + "' is not a PLY number type");
}

Encoding parseEncoding(std::string_view word)
{
    if (word == "ascii") return Encoding::text;
    if (word == "binary_little_endian") return Encoding::littleEndian;
    if (word == "binary_big_endian") return Encoding::bigEndian;
    throw std::runtime_error("'" + printable(word) + "' is not a PLY encoding");
}

Property parseProperty(std::string_view line)
{
    Property property;
    std::string_view word = takeWord(line);
    property.isList = word == "list";
    if (property.isList)
    {
        property.countType = parseType(takeWord(line));
        word = takeWord(line);
    }
    property.type = parseType(word);
    property.name = takeWord(line);
    return property;
}

/// Removes the header, including the line break after end_header, from the front of `bytes`. Some exporters write lines
/// of their own before the first element without marking them as comments: these are skipped.
Header takeHeader(std::string_view& bytes)
{
    Header header;
    for (bool first = true;; first = false)
    {
        const std::size_t length = bytes.find('\n');
        if (length == std::string_view::npos) throw std::runtime_error("the header has no end_header line");
        std::string_view line = bytes.substr(0, length);
        bytes.remove_prefix(length + 1);
        const std::string_view key = takeWord(line);
        if (first != (key == "ply")) throw std::runtime_error("a PLY file has 'ply' on its first line, and only there");
        if (key == "end_header") return header;
        if (key == "format")
            header.encoding = parseEncoding(takeWord(line));
        else if (key == "element")
        {
            Element element;
            element.name = takeWord(line);
            element.count = parseNumber<std::int64_t>(takeWord(line), "an element count");
            header.elements.push_back(element);
        }
        else if (key == "property" && !header.elements.empty())
            header.elements.back().properties.push_back(parseProperty(line));
        else if (!key.empty() && key != "ply" && key != "comment" && key != "obj_info" && !header.elements.empty())
            throw std::runtime_error("unexpected '" + printable(key) + "' in the header");
    }
}

/// Reads the numbers of the body in sequence.
class PlyBody
{
public:
    PlyBody(std::string_view bytes, Encoding encoding) : m_rest(bytes), m_encoding(encoding) {}

    double next(NumberType type)
    {
        if (m_encoding == Encoding::text)
        {
            const std::string_view word = takeWord(m_rest);
            if (word.empty()) throw std::runtime_error("the file ends too early");
            return parseNumber<double>(word, "a number");
        }
        return nextBinary(type);
    }
    /// A count or an index: an integer in [0, 2^31).
    int nextIndex(NumberType type)
    {
        const double value = next(type);
        if (!(value >= 0 && value <= INT_MAX) || value != static_cast<int>(value))
            throw std::runtime_error(message(value, " is not a count or a vertex index"));
        return static_cast<int>(value);
    }

private:
    double nextBinary(NumberType type)
    {
        const auto size = static_cast<std::size_t>(type.size);
        if (m_rest.size() < size) throw std::runtime_error("the file ends too early");
        const ByteOrder order = m_encoding == Encoding::bigEndian ? ByteOrder::big : ByteOrder::little;
        const std::uint64_t bits = readBits(m_rest.data(), size, order);
        m_rest.remove_prefix(size);
        return doubleFromBits(bits, type);
    }

    std::string_view m_rest;
    Encoding m_encoding;
};

/// Shift of a colour component in 0xRRGGBB; -1 if the property is no colour.
int colourShift(const std::string& name)
{
    return name == "red" ? 16 : name == "green" ? 8 : name == "blue" ? 0 : -1;
}

/// A colour component in [0, 255]. Floating-point components are in [0, 1]; NaN counts as 0.
int colourOf(double value, NumberType type)
{
    if (type.kind == NumberType::floating) value = std::round(255 * value);
    return value >= 0 ? static_cast<int>(std::min(value, 255.0)) : 0;
}

bool isColoured(const Element& element)
{
    int colours = 0;
    for (const Property& property : element.properties) colours += !property.isList && colourShift(property.name) >= 0;
    return colours == 3;
}

/// Reads one item of an element; properties other than position, colour and corners are dropped.
void readItem(PlyBody& body, const Element& element, PolygonMesh& mesh)
{
    const bool isVertex = element.name == "vertex", isFace = element.name == "face";
    Vec3 x;
    int colour = 0;
    for (const Property& property : element.properties)
    {
        if (property.isList)
        {
            const bool corners = isFace && (property.name == "vertex_indices" || property.name == "vertex_index");
            const int count = body.nextIndex(property.countType);
            for (int i = 0; i < count; ++i)
            {
                if (corners)
                    mesh.m_corners.push_back(body.nextIndex(property.type));
                else
                    body.next(property.type);
            }
            continue;
        }
        const double value = body.next(property.type);
        if (const int shift = colourShift(property.name); shift >= 0 && isVertex)
            colour |= colourOf(value, property.type) << shift;
        if (property.name.size() == 1 && property.name[0] >= 'x' && property.name[0] <= 'z')
            x[property.name[0] - 'x'] = value;
    }
    if (isVertex) mesh.m_positions.push_back(x);
    if (isVertex && isColoured(element)) mesh.m_labels.push_back(colour);
    if (isFace) mesh.closeFace();
}

void checkVertexProperties(const Element& element)
{
    for (const char* axis : {"x", "y", "z"})
    {
        int count = 0;
        for (const Property& property : element.properties) count += property.name == axis && !property.isList;
        if (count != 1)
            throw std::runtime_error("element 'vertex' has " + std::to_string(count) + " properties '" + axis +
                                     "', not one");
    }
}

}  // namespace

PolygonMesh readPly(std::string_view bytes)
{
    const Header header = takeHeader(bytes);
    PlyBody body(bytes, header.encoding);
    PolygonMesh mesh;
    for (const Element& element : header.elements)
    {
        if (element.name == "vertex") checkVertexProperties(element);
        if (element.properties.empty()) continue;  // no data, whatever the count
        for (std::int64_t i = 0; i < element.count; ++i)
        {
            try
            {
                readItem(body, element, mesh);
            }
            catch (const std::runtime_error& error)
            {
                throw std::runtime_error(printable(element.name) + " " + std::to_string(i) + " of " +
                                         std::to_string(element.count) + ": " + error.what());
            }
        }
    }
    if (mesh.m_labels.size() != mesh.m_positions.size())
        mesh.m_labels.clear();  // several vertex elements, not all painted
    return mesh;
}

}  // namespace bullet_fem

// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "io/tet/vtu_array.h"

#include <tinyxml2.h>
#include <zlib.h>

#include <algorithm>
#include <stdexcept>

#include "fem/common/message.h"
#include "io/text/number_text.h"

namespace bullet_fem
{
namespace
{

constexpr std::uint64_t kMaxInflation = 1032;  // maximum expansion by deflate, bytes per byte

/// A sequence of raw or base64 bytes, consumed from the front. Errors are std::runtime_error.
class EncodedBytes
{
public:
    EncodedBytes(std::string_view text, bool base64) : m_rest(text), m_base64(base64) {}

    /// The next bytes; throws if there are fewer. Base64 may contain padding in its middle, as after a separately
    /// encoded header.
    std::string take(std::size_t count);

    /// Upper bound of the remaining bytes.
    std::size_t most() const { return m_pending.size() + (m_base64 ? m_rest.size() / 4 * 3 : m_rest.size()); }

private:
    bool decodeQuartet(std::string& bytes);

    std::string_view m_rest;
    bool m_base64;
    std::string m_pending;  // decoded, not yet consumed
};

/// The six bits of a base64 digit, or -1.
int base64Digit(char c)
{
    if (c >= 'A' && c <= 'Z') return c - 'A';
    if (c >= 'a' && c <= 'z') return c - 'a' + 26;
    if (c >= '0' && c <= '9') return c - '0' + 52;
    return c == '+' ? 62 : c == '/' ? 63 : -1;
}

/// Appends the up to three bytes of the next four digits; false at the end.
bool EncodedBytes::decodeQuartet(std::string& bytes)
{
    std::uint32_t bits = 0;
    int digits = 0, padding = 0;
    for (std::size_t at = 0; at < m_rest.size(); ++at)
    {
        const char c = m_rest[at];
        if (c == ' ' || c == '\n' || c == '\r' || c == '\t') continue;
        const int digit = base64Digit(c);
        if (c == '=' && digits >= 2)
            ++padding;
        else if (digit < 0 || padding > 0)
            throw std::runtime_error(message("byte ", static_cast<int>(static_cast<unsigned char>(c)),
                                             " is not base64 where a digit should be"));
        else
            ++digits;
        bits = bits << 6 | static_cast<std::uint32_t>(std::max(digit, 0));
        if (digits + padding < 4) continue;
        for (int i = 0; i + 1 < digits; ++i) bytes += static_cast<char>(bits >> (16 - 8 * i) & 0xff);
        m_rest.remove_prefix(at + 1);
        return true;
    }
    return false;
}

std::string EncodedBytes::take(std::size_t count)
{
    if (count > most())
        throw std::runtime_error(message(count, " bytes should follow where ", most(), " are left at most"));
    std::string bytes;
    if (!m_base64)
    {
        bytes = m_rest.substr(0, count);
        m_rest.remove_prefix(count);
        return bytes;
    }
    bytes.reserve(count + 2);
    bytes.swap(m_pending);
    while (bytes.size() < count)
        if (!decodeQuartet(bytes))
            throw std::runtime_error(message("base64 ends after ", bytes.size(), " of ", count, " bytes"));
    m_pending = bytes.substr(count);
    bytes.resize(count);
    return bytes;
}

NumberType parseVtuType(const std::string& name)
{
    struct Named
    {
        const char* name;
        NumberType type;
    };
    static const Named types[] = {
        {"Int8", {NumberType::signedInteger, 1}},  {"UInt8", {NumberType::unsignedInteger, 1}},
        {"Int16", {NumberType::signedInteger, 2}}, {"UInt16", {NumberType::unsignedInteger, 2}},
        {"Int32", {NumberType::signedInteger, 4}}, {"UInt32", {NumberType::unsignedInteger, 4}},
        {"Int64", {NumberType::signedInteger, 8}}, {"UInt64", {NumberType::unsignedInteger, 8}},
        {"Float32", {NumberType::floating, 4}},    {"Float64", {NumberType::floating, 8}}};
    for (const Named& known : types)
        if (name == known.name) return known.type;
    throw std::runtime_error("its type '" + name + "' is not one of Int8 to UInt64, Float32 and Float64");
}

std::uint64_t takeCount(EncodedBytes& bytes, const VtuArrayEncoding& encoding)
{
    const auto size = static_cast<std::size_t>(encoding.headerBytes);
    return readBits(bytes.take(size).data(), size, encoding.order);
}

/// Counts numbers before they are decoded.
void spend(VtuArrayEncoding& encoding, std::uint64_t numbers)
{
    if (numbers > encoding.numbersLeft)
        throw std::runtime_error("the file decodes to far more numbers than it has bytes; save without compression");
    encoding.numbersLeft -= numbers;
}

/// Decompresses a block that should have `size` bytes, and appends it.
void inflateBlock(const std::string& block, std::uint64_t size, std::string& out)
{
    if (size > kMaxInflation * (block.size() + 1))
        throw std::runtime_error(message("a zlib block of ", block.size(), " bytes cannot hold ", size));
    const std::size_t before = out.size();
    out.resize(before + static_cast<std::size_t>(size) + 1);  // one more, to detect excess data
    auto inflated = static_cast<uLongf>(size + 1);
    const int status = uncompress(reinterpret_cast<Bytef*>(&out[before]), &inflated,
                                  reinterpret_cast<const Bytef*>(block.data()), static_cast<uLong>(block.size()));
    if (status != Z_OK || inflated != size)
        throw std::runtime_error(message("a zlib block does not decompress to ", size, " bytes"));
    out.resize(before + static_cast<std::size_t>(size));
}

/// Binary data after its header: the number of bytes, or, with compression, the number of blocks, the bytes of each, of
/// the last one if that is shorter (else 0), and the compressed bytes of each.
std::string decode(EncodedBytes bytes, std::uint64_t numberBytes, VtuArrayEncoding& encoding)
{
    const std::uint64_t count = takeCount(bytes, encoding);
    if (!encoding.compressed)
    {
        spend(encoding, count / numberBytes);
        return bytes.take(static_cast<std::size_t>(count));
    }
    if (count == 0) return {};
    const std::uint64_t size = takeCount(bytes, encoding), partSize = takeCount(bytes, encoding);
    if (count > bytes.most() / static_cast<std::uint64_t>(encoding.headerBytes))
        throw std::runtime_error(message("it declares ", count, " blocks in ", bytes.most(), " bytes"));
    std::vector<std::uint64_t> compressed(static_cast<std::size_t>(count));
    for (std::uint64_t& block : compressed) block = takeCount(bytes, encoding);
    std::string out;
    for (std::size_t b = 0; b < compressed.size(); ++b)
    {
        const std::uint64_t inflated = partSize > 0 && b + 1 == compressed.size() ? partSize : size;
        spend(encoding, inflated / numberBytes);
        inflateBlock(bytes.take(static_cast<std::size_t>(compressed[b])), inflated, out);
    }
    return out;
}

std::string_view textOf(const tinyxml2::XMLElement& array)
{
    const char* text = array.GetText();
    return text ? std::string_view(text) : std::string_view();
}

EncodedBytes encodedBytes(const tinyxml2::XMLElement& array, const std::string& format,
                          const VtuArrayEncoding& encoding)
{
    if (format == "binary") return EncodedBytes(textOf(array), true);
    const auto offset = parseNumber<std::uint64_t>(vtuAttribute(array, "offset"), "an offset");
    if (offset >= encoding.appended.size())
        throw std::runtime_error(
            message("its offset is ", offset, ", but AppendedData has ", encoding.appended.size(), " bytes"));
    return EncodedBytes(encoding.appended.substr(static_cast<std::size_t>(offset)), encoding.appendedBase64);
}

template <class Number>
std::vector<Number> readText(std::string_view text)
{
    std::vector<Number> numbers;
    for (std::string_view word = takeWord(text); !word.empty(); word = takeWord(text))
        numbers.push_back(parseNumber<Number>(word, std::is_integral_v<Number> ? "an integer" : "a number"));
    return numbers;
}

template <class Number>
std::vector<Number> readNumbers(const tinyxml2::XMLElement& array, VtuArrayEncoding& encoding)
{
    const NumberType type = parseVtuType(vtuAttribute(array, "type"));
    if (std::is_integral_v<Number> && type.kind == NumberType::floating)
        throw std::runtime_error("its type is not an integer");
    const std::string format = vtuAttribute(array, "format");
    if (format.empty() || format == "ascii") return readText<Number>(textOf(array));
    if (format != "binary" && format != "appended")
        throw std::runtime_error("its format '" + format + "' is not ascii, binary or appended");
    const auto size = static_cast<std::size_t>(type.size);
    const std::string bytes = decode(encodedBytes(array, format, encoding), size, encoding);
    if (bytes.size() % size != 0)
        throw std::runtime_error(message(bytes.size(), " bytes are no whole number of ", size, "-byte numbers"));
    std::vector<Number> numbers;
    numbers.reserve(bytes.size() / size);
    for (std::size_t at = 0; at < bytes.size(); at += size)
    {
        const std::uint64_t bits = readBits(bytes.data() + at, size, encoding.order);
        if constexpr (std::is_integral_v<Number>)
            numbers.push_back(integerFromBits(bits, type));
        else
            numbers.push_back(doubleFromBits(bits, type));
    }
    return numbers;
}

/// Prepends the element's line and name to exceptions.
template <class Number>
std::vector<Number> readNamed(const tinyxml2::XMLElement& array, VtuArrayEncoding& encoding)
{
    try
    {
        return readNumbers<Number>(array, encoding);
    }
    catch (const std::runtime_error& error)
    {
        throw std::runtime_error(
            message("line ", array.GetLineNum(), ": DataArray '", vtuAttribute(array, "Name"), "': ", error.what()));
    }
}

}  // namespace

std::string vtuAttribute(const tinyxml2::XMLElement& element, const char* name, const char* otherwise)
{
    const char* value = element.Attribute(name);
    return value ? printable(value) : std::string(otherwise);
}

std::vector<double> readVtuDoubles(const tinyxml2::XMLElement& array, VtuArrayEncoding& encoding)
{
    return readNamed<double>(array, encoding);
}

std::vector<std::int64_t> readVtuIntegers(const tinyxml2::XMLElement& array, VtuArrayEncoding& encoding)
{
    return readNamed<std::int64_t>(array, encoding);
}

}  // namespace bullet_fem

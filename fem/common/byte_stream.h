// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string>
#include <type_traits>
#include <vector>

#include "bullet_fem/fem/common/quaternion.h"
#include "bullet_fem/fem/common/symmetric.h"
#include "bullet_fem/fem/common/vec3.h"
#include "fem/common/message.h"

namespace bullet_fem
{

// Serialization to bytes and back, in the machine's own byte order, without padding: equal values give equal bytes. One
// list of members serves both directions: for a type T define
//     template <class Bytes> void transfer(Bytes& bytes, T& value) { bytes(value.m_a, value.m_b); }
// in T's namespace. Numbers, enums, bools, Vec3, Mat3, quaternions, strings, and arrays and vectors of serializable
// types are supported.

/// True for types that are copied byte by byte: they have no padding, and every bit pattern is a value.
template <class T>
inline constexpr bool isCopiedAsBytes =
    (std::is_arithmetic_v<T> && !std::is_same_v<T, bool>) || std::is_enum_v<T> || std::is_same_v<T, Vec3> ||
    std::is_same_v<T, Mat3> || std::is_same_v<T, Quaternion> || std::is_same_v<T, SymmetricTensor>;
static_assert(sizeof(Vec3) == 3 * sizeof(double) && sizeof(Mat3) == 9 * sizeof(double) &&
              sizeof(Quaternion) == 4 * sizeof(float) && sizeof(SymmetricTensor) == 6 * sizeof(double));

template <class T>
inline constexpr bool isCopiedAsBytes<std::array<T, 3>> = isCopiedAsBytes<T>;

/// Appends values to a vector of bytes.
class ByteWriter
{
public:
    /// `bytes` must outlive the writer.
    explicit ByteWriter(std::vector<unsigned char>& bytes) : m_bytes(bytes) {}

    template <class... Values>
    void operator()(Values&... values)
    {
        (transfer(*this, values), ...);
    }

    void raw(const void* data, std::size_t size)
    {
        const std::size_t before = m_bytes.size();
        m_bytes.resize(before + size);
        if (size > 0) std::memcpy(m_bytes.data() + before, data, size);
    }

private:
    std::vector<unsigned char>& m_bytes;
};

/// Deserializes values from arbitrary bytes. Throws std::invalid_argument if the bytes end too early, before allocating
/// memory for missing elements.
class ByteReader
{
public:
    ByteReader(const unsigned char* data, std::size_t size) : m_next(data), m_left(size) {}

    template <class... Values>
    void operator()(Values&... values)
    {
        (transfer(*this, values), ...);
    }

    void raw(void* data, std::size_t size)
    {
        need(size);
        if (size > 0) std::memcpy(data, m_next, size);
        m_next += size;
        m_left -= size;
    }

    /// Reads the number of elements that follow, each of at least `bytesEach` bytes.
    std::size_t count(std::size_t bytesEach)
    {
        std::uint64_t count = 0;
        raw(&count, sizeof count);
        if (count > m_left / bytesEach) reject("a list of ", count, " elements in ", m_left, " bytes");
        return static_cast<std::size_t>(count);
    }

    std::size_t left() const { return m_left; }

private:
    void need(std::size_t size) const
    {
        if (size > m_left) reject("it ends ", size - m_left, " bytes too early");
    }

    const unsigned char* m_next;
    std::size_t m_left;
};

template <class Bytes, class T>
std::enable_if_t<isCopiedAsBytes<T>> transfer(Bytes& bytes, T& value)
{
    bytes.raw(&value, sizeof value);
}

inline void transfer(ByteWriter& bytes, bool& value)
{
    const unsigned char byte = value ? 1 : 0;
    bytes.raw(&byte, 1);
}

inline void transfer(ByteReader& bytes, bool& value)
{
    unsigned char byte = 0;
    bytes.raw(&byte, 1);
    if (byte > 1) reject("a yes or no that is ", static_cast<int>(byte));
    value = byte == 1;
}

template <class Bytes, class T, std::size_t count>
std::enable_if_t<!isCopiedAsBytes<std::array<T, count>>> transfer(Bytes& bytes, std::array<T, count>& values)
{
    for (T& value : values) transfer(bytes, value);
}

template <class T>
void transfer(ByteWriter& bytes, std::vector<T>& values)
{
    const std::uint64_t count = values.size();
    bytes.raw(&count, sizeof count);
    if constexpr (isCopiedAsBytes<T>)
        bytes.raw(values.data(), count * sizeof(T));
    else
        for (T& value : values) transfer(bytes, value);
}

template <class T>
void transfer(ByteReader& bytes, std::vector<T>& values)
{
    values.clear();
    if constexpr (isCopiedAsBytes<T>)
    {
        values.resize(bytes.count(sizeof(T)));
        bytes.raw(values.data(), values.size() * sizeof(T));
    }
    else
    {
        // One at a time: an element may be larger in memory than in the bytes.
        for (std::size_t left = bytes.count(1); left > 0; --left)
        {
            values.emplace_back();
            transfer(bytes, values.back());
        }
    }
}

inline void transfer(ByteWriter& bytes, std::string& text)
{
    const std::uint64_t count = text.size();
    bytes.raw(&count, sizeof count);
    bytes.raw(text.data(), text.size());
}

inline void transfer(ByteReader& bytes, std::string& text)
{
    text.resize(bytes.count(1));
    bytes.raw(&text[0], text.size());
}

/// FNV-1a hash over numbers instead of bytes: a change of any single number changes the hash.
constexpr std::uint64_t kEmptyMark = 14695981039346656037u;

template <class Number>
void addToMark(std::uint64_t& mark, Number value)
{
    std::uint64_t bits = 0;
    static_assert(sizeof value <= sizeof bits);
    std::memcpy(&bits, &value, sizeof value);
    mark = (mark ^ bits) * 1099511628211u;
}

/// Hash of a byte array, eight bytes at a time.
inline std::uint64_t markOfBytes(const unsigned char* data, std::size_t size)
{
    std::uint64_t mark = kEmptyMark;
    for (std::size_t k = 0; k < size; k += 8)
    {
        std::uint64_t word = 0;
        std::memcpy(&word, data + k, size - k < 8 ? size - k : 8);
        addToMark(mark, word);
    }
    addToMark(mark, size);
    return mark;
}

}  // namespace bullet_fem

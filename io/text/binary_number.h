// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>

namespace bullet_fem
{

enum class ByteOrder
{
    little,
    big
};

/// A type of numbers in files.
struct NumberType
{
    enum Kind
    {
        signedInteger,
        unsignedInteger,
        floating
    } kind;
    int size;  ///< [bytes]: 1, 2, 4 or 8; of floating 4 or 8
};

/// The bits of a number of `size` bytes, at most 8, whatever the order of this machine.
inline std::uint64_t readBits(const char* bytes, std::size_t size, ByteOrder order)
{
    std::uint64_t bits = 0;
    for (std::size_t i = 0; i < size; ++i)
        bits = bits << 8 | static_cast<unsigned char>(bytes[order == ByteOrder::big ? i : size - 1 - i]);
    return bits;
}

/// The integer of the given type with these bits, modulo 2^64.
inline std::int64_t integerFromBits(std::uint64_t bits, NumberType type)
{
    const int spare = 64 - 8 * type.size;  // an arithmetic shift to the right repeats the sign
    return type.kind == NumberType::signedInteger ? static_cast<std::int64_t>(bits << spare) >> spare
                                                  : static_cast<std::int64_t>(bits);
}

/// The value of the given type with these bits, rounded to a double.
inline double doubleFromBits(std::uint64_t bits, NumberType type)
{
    if (type.kind == NumberType::unsignedInteger) return static_cast<double>(bits);
    if (type.kind == NumberType::signedInteger) return static_cast<double>(integerFromBits(bits, type));
    if (type.size == 8)
    {
        double value;
        std::memcpy(&value, &bits, sizeof value);
        return value;
    }
    const auto bits32 = static_cast<std::uint32_t>(bits);
    float value;
    std::memcpy(&value, &bits32, sizeof value);
    return value;
}

}  // namespace bullet_fem

// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstring>
#include <sstream>
#include <string>

namespace bullet_fem
{

/// Builds a file from text and binary numbers.
class ByteText
{
public:
    explicit ByteText(bool bigEndian = false) : m_bigEndian(bigEndian) {}

    template <class Value>
    ByteText& operator<<(const Value& value)
    {
        std::ostringstream text;
        text.precision(17);
        text << value;
        m_bytes += text.str();
        return *this;
    }

    /// Appends a binary number in the file's byte order, reversed on a machine of the other order.
    template <class Number>
    ByteText& raw(Number value)
    {
        char bytes[sizeof value];
        std::memcpy(bytes, &value, sizeof value);
        if (m_bigEndian) std::reverse(bytes, bytes + sizeof value);
        m_bytes.append(bytes, sizeof value);
        return *this;
    }

    const std::string& bytes() const { return m_bytes; }

private:
    std::string m_bytes;
    bool m_bigEndian;
};

}  // namespace bullet_fem

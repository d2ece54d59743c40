// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "io/tet/encoded_bytes.h"

#include <algorithm>
#include <cstdint>
#include <stdexcept>

#include "fem/common/message.h"

namespace bullet_fem
{
namespace
{

/// The six bits of a base64 digit, or -1.
int base64Digit(char c)
{
    if (c >= 'A' && c <= 'Z') return c - 'A';
    if (c >= 'a' && c <= 'z') return c - 'a' + 26;
    if (c >= '0' && c <= '9') return c - '0' + 52;
    return c == '+' ? 62 : c == '/' ? 63 : -1;
}

}  // namespace

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

}  // namespace bullet_fem

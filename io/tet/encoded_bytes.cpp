// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "io/tet/encoded_bytes.h"

#include <algorithm>
#include <cstdint>
#include <stdexcept>

#include "fem/message.h"

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

/// Four digits to up to three pending bytes; false at the end.
bool EncodedBytes::decodeQuartet()
{
    std::uint32_t bits = 0;
    int digits = 0, padding = 0;
    while (digits + padding < 4)
    {
        m_rest.remove_prefix(std::min(m_rest.find_first_not_of(" \t\r\n"), m_rest.size()));
        if (m_rest.empty()) return false;
        const char c = m_rest.front();
        const int digit = base64Digit(c);
        if (c == '=' && digits >= 2)
            ++padding;
        else if (digit < 0 || padding > 0)
            throw std::runtime_error(message("byte ", static_cast<int>(static_cast<unsigned char>(c)),
                                             " is not base64 where a digit should be"));
        else
            ++digits;
        bits = bits << 6 | static_cast<std::uint32_t>(std::max(digit, 0));
        m_rest.remove_prefix(1);
    }
    for (int i = 0; i + 1 < digits; ++i) m_pending += static_cast<char>(bits >> (16 - 8 * i) & 0xff);
    return true;
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
    {
        if (!decodeQuartet())
            throw std::runtime_error(message("base64 ends after ", bytes.size(), " of ", count, " bytes"));
        bytes += m_pending;
        m_pending.clear();
    }
    m_pending = bytes.substr(count);
    bytes.resize(count);
    return bytes;
}

}  // namespace bullet_fem

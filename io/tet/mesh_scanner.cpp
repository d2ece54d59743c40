// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "io/tet/mesh_scanner.h"

#include <algorithm>

#include "fem/common/message.h"

namespace bullet_fem
{

constexpr std::string_view kSpace = " \t\r\n\v\f";

void MeshScanner::skipSpace()
{
    for (;;)
    {
        m_next = std::min(m_bytes.find_first_not_of(kSpace, m_next), m_bytes.size());
        if (!m_comments || m_next == m_bytes.size() || m_bytes[m_next] != '#') return;
        m_next = std::min(m_bytes.find('\n', m_next), m_bytes.size());
    }
}

bool MeshScanner::atEnd()
{
    skipSpace();
    return left() == 0;
}

std::string_view MeshScanner::restOfLine()
{
    m_item = m_next;
    const std::size_t end = std::min(m_bytes.find('\n', m_next), m_bytes.size());
    std::string_view line = m_bytes.substr(m_next, end - m_next);
    m_next = std::min(end + 1, m_bytes.size());
    if (m_comments) line = line.substr(0, line.find('#'));
    if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
    return line;
}

std::string_view MeshScanner::peekWord()
{
    skipSpace();
    const std::size_t end = m_bytes.find_first_of(m_comments ? " \t\r\n\v\f#" : kSpace, m_next);
    return m_bytes.substr(m_next, std::min(end, m_bytes.size()) - m_next);
}

std::string_view MeshScanner::word(const char* what)
{
    const std::string_view word = peekWord();
    m_item = m_next;
    if (word.empty()) failAtEnd(what);
    m_next += word.size();
    return word;
}

bool MeshScanner::skipPast(std::string_view mark)
{
    const std::size_t at = m_bytes.find(mark, m_next);
    if (at == std::string_view::npos) return false;
    m_next = at + mark.size();
    return true;
}

void MeshScanner::skipBytes(std::uint64_t count, const char* what)
{
    m_item = m_next;
    if (count > left()) failAtEnd(what);
    m_next += static_cast<std::size_t>(count);
}

void MeshScanner::need(std::uint64_t count, std::uint64_t numbers, std::uint64_t bytesEach, const char* what)
{
    const std::uint64_t each = numbers * (m_binary ? bytesEach : 2);
    const std::uint64_t room = m_binary ? left() : std::uint64_t{left()} + 1;  // no space after the last number
    if (count > room / each)
        fail(message("it declares ", count, " ", what, ", but the ", left(), " bytes that are left hold ", room / each,
                     " at most; the file is cut short or damaged"));
}

std::string MeshScanner::place() const
{
    if (m_binary) return message("byte ", m_item);
    const auto end = m_bytes.begin() + static_cast<std::ptrdiff_t>(m_item);
    return message("line ", 1 + std::count(m_bytes.begin(), end, '\n'));
}

void MeshScanner::fail(const std::string& cause) const
{
    throw std::runtime_error(place() + ": " + cause);
}

void MeshScanner::failAtEnd(const char* what)
{
    fail(message("the file ends where ", what, " should be"));
}

}  // namespace bullet_fem

// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <type_traits>

#include "io/text/binary_number.h"
#include "io/text/number_text.h"

namespace bullet_fem
{

/// The bytes of a mesh file from front to back, in turns as text and as binary numbers. Every error is a
/// std::runtime_error that begins with the line, or with the byte once setBinary was called. Memory is not its own.
class MeshScanner
{
public:
    /// Text. With `comments` whatever follows a # up to the end of its line is not there.
    explicit MeshScanner(std::string_view bytes, bool comments = false) : m_bytes(bytes), m_comments(comments) {}

    /// From here on get() reads binary numbers of this byte order.
    void setBinary(ByteOrder order)
    {
        m_binary = true;
        m_order = order;
    }
    bool isBinary() const { return m_binary; }

    bool atEnd();  ///< Nothing but white space is left.
    std::string_view
    restOfLine();  ///< Up to the next line break, which is passed; neither it nor a \r before it is kept.
    std::string_view word(const char* what);  ///< The next word, over line breaks; fails at the end.
    std::string_view peekWord();              ///< The same without passing it; empty at the end.
    bool skipPast(std::string_view mark);     ///< Passes the next such text; false if there is none.
    void skipBytes(std::uint64_t count, const char* what);

    /// The next word as a number.
    template <class Number>
    Number text(const char* what)
    {
        return parse<Number>(word(what), what);
    }

    /// A word of what was read last as a number.
    template <class Number>
    Number parse(std::string_view word, const char* what) const
    {
        try
        {
            return parseNumber<Number>(word, what);
        }
        catch (const std::runtime_error& error)
        {
            fail(error.what());
        }
    }

    /// The bits of a binary number of 1 to 8 bytes.
    std::uint64_t bits(int size, const char* what)
    {
        m_item = m_next;
        if (left() < static_cast<std::size_t>(size)) failAtEnd(what);
        m_next += static_cast<std::size_t>(size);
        return readBits(m_bytes.data() + m_item, static_cast<std::size_t>(size), m_order);
    }

    /// A number in the file's encoding; `bytes` is its size in binary files if that is not the type's own.
    template <class Number>
    Number get(const char* what, int bytes = sizeof(Number))
    {
        if (!m_binary) return text<Number>(what);
        if constexpr (std::is_floating_point_v<Number>)
            return static_cast<Number>(doubleFromBits(bits(bytes, what), {NumberType::floating, bytes}));
        else
            return static_cast<Number>(bits(bytes, what));
    }

    /// Fails unless the rest can hold `count` things of `numbers` numbers, which are of `bytesEach` bytes in binary
    /// files and of a digit and a space, at least, in text.
    void need(std::uint64_t count, std::uint64_t numbers, std::uint64_t bytesEach, const char* what);

    std::size_t left() const { return m_bytes.size() - m_next; }
    const char* data() const { return m_bytes.data() + m_next; }

    /// Throws, with the line or byte of what was read last.
    [[noreturn]] void fail(const std::string& cause) const;
    /// "line 7", or "byte 100" in binary files, of what was read last.
    std::string place() const;

private:
    void skipSpace();
    [[noreturn]] void failAtEnd(const char* what);

    std::string_view m_bytes;
    std::size_t m_next = 0;
    std::size_t m_item = 0;  // where what was read last begins
    bool m_comments = false;
    bool m_binary = false;
    ByteOrder m_order = ByteOrder::little;
};

}  // namespace bullet_fem

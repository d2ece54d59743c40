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

/// Sequential reader of a mesh file's bytes, alternately as text and as binary numbers. Every error is a
/// std::runtime_error that begins with the line, or with the byte after setBinary. Does not own its memory.
class MeshScanner
{
public:
    /// Begins as text. With `comments`, everything from a # to the end of its line is ignored.
    explicit MeshScanner(std::string_view bytes, bool comments = false) : m_bytes(bytes), m_comments(comments) {}

    /// Makes get() read binary numbers of this byte order.
    void setBinary(ByteOrder order)
    {
        m_binary = true;
        m_order = order;
    }
    bool isBinary() const { return m_binary; }

    bool atEnd();  ///< True if only white space is left.
    std::string_view
    restOfLine();  ///< Up to the next line break, which is passed; neither it nor a \r before it is kept.
    std::string_view word(const char* what);  ///< The next word, over line breaks; fails at the end.
    std::string_view peekWord();              ///< The next word, without advancing; empty at the end.
    bool skipPast(std::string_view mark);  ///< Advances beyond the next occurrence of `mark`; false if there is none.
    void skipBytes(std::uint64_t count, const char* what);

    /// The next word as a number.
    template <class Number>
    Number text(const char* what)
    {
        return parse<Number>(word(what), what);
    }

    /// A word of the last item as a number.
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

    /// Fails unless the rest can hold `count` items of `numbers` numbers, each with `bytesEach` bytes in binary files,
    /// and at least a digit and a space in text.
    void need(std::uint64_t count, std::uint64_t numbers, std::uint64_t bytesEach, const char* what);

    std::size_t left() const { return m_bytes.size() - m_next; }
    const char* data() const { return m_bytes.data() + m_next; }

    /// Throws, with the line or byte of the last item.
    [[noreturn]] void fail(const std::string& cause) const;
    /// Position of the last item: "line 7", or "byte 100" in binary files.
    std::string place() const;

private:
    void skipSpace();
    [[noreturn]] void failAtEnd(const char* what);

    std::string_view m_bytes;
    std::size_t m_next = 0;
    std::size_t m_item = 0;  // start of the last item
    bool m_comments = false;
    bool m_binary = false;
    ByteOrder m_order = ByteOrder::little;
};

}  // namespace bullet_fem

// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <charconv>
#include <stdexcept>
#include <string>
#include <string_view>
#ifndef __cpp_lib_to_chars
#include <cerrno>
#include <clocale>
#include <cmath>
#include <cstdlib>
#include <type_traits>
#ifdef __APPLE__
#include <xlocale.h>
#endif
#endif

namespace bullet_fem
{

/// Removes the next word from the front of `text`, skipping white space; empty at the end.
inline std::string_view takeWord(std::string_view& text)
{
    constexpr std::string_view space = " \t\r\n\v\f";
    const std::size_t first = text.find_first_not_of(space);
    if (first == std::string_view::npos)
    {
        text = {};
        return {};
    }
    text.remove_prefix(first);
    const std::string_view word = text.substr(0, text.find_first_of(space));
    text.remove_prefix(word.size());
    return word;
}

/// A word of a file for a message, its first 40 characters; bytes that are not printable are described in words, for
/// they could be control sequences of a terminal.
inline std::string printable(std::string_view word)
{
    const std::string_view text = word.substr(0, 40);
    for (const char c : text)
        if (c < ' ' || c > '~') return "(unprintable bytes)";
    return std::string(text);
}

#ifndef __cpp_lib_to_chars  // from_chars of libc++ before 20 reads integers only
/// Replacement of std::from_chars for a whole word, by strtod in the locale "C".
inline bool readReal(const std::string& digits, double& value)
{
    static const locale_t c = newlocale(LC_ALL_MASK, "C", nullptr);
    if (digits.empty() || digits[0] == '+' || digits.find_first_of("xX") != std::string::npos) return false;
    char* end = nullptr;
    errno = 0;
    value = strtod_l(digits.c_str(), &end, c);
    const bool outOfRange = errno == ERANGE && (value == 0 || std::isinf(value));
    return end == digits.c_str() + digits.size() && !outOfRange;
}
#endif

/// Whether all of `digits` is a number in any locale; writes it to `value`.
template <typename Number>
bool readNumber(std::string_view digits, Number& value)
{
#ifndef __cpp_lib_to_chars
    if constexpr (std::is_same_v<Number, double>)
        return readReal(std::string(digits), value);
    else
#endif
    {
        const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
        return error == std::errc() && end == digits.data() + digits.size();
    }
}

/// A whole word as a number, independent of the locale. Throws std::runtime_error naming the word and the expected
/// `what`.
template <typename Number>
Number parseNumber(std::string_view word, const char* what)
{
    Number value = 0;
    const std::string_view digits = word.substr(word.size() > 1 && word[0] == '+' ? 1 : 0);
    if (!readNumber(digits, value)) throw std::runtime_error("'" + printable(word) + "' is not " + what);
    return value;
}

}  // namespace bullet_fem

// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <charconv>
#include <stdexcept>
#include <string>
#include <string_view>

namespace bullet_fem
{

/// Takes the next word off the front of `text`, skipping white space; empty at the end.
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

/// A word of a file for a message: what is too long or not printable, and could be meant for a terminal, is left out.
inline std::string printable(std::string_view word)
{
    std::string text(word.substr(0, 40));
    for (char& c : text)
        if (c < ' ' || c > '~') c = '?';
    return text;
}

/// A whole word as a number, whatever the locale. Throws std::runtime_error naming the word and `what` it should be.
template <typename Number>
Number parseNumber(std::string_view word, const char* what)
{
    Number value = 0;
    const std::string_view digits = word.substr(word.size() > 1 && word[0] == '+' ? 1 : 0);
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
    if (error != std::errc() || end != digits.data() + digits.size())
        throw std::runtime_error("'" + printable(word) + "' is not " + what);
    return value;
}

}  // namespace bullet_fem

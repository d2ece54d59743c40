// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <stdexcept>
#include <string>

namespace bullet_fem
{

/// Invalid JSON. what() is "line 3, column 7: " and the message.
class JsonSyntaxError : public std::runtime_error
{
public:
    JsonSyntaxError(int line, int column, const std::string& message);

    int line() const { return m_line; }      ///< from 1
    int column() const { return m_column; }  ///< from 1, in characters of UTF-8
    /// The expected text and the text found.
    const std::string& message() const { return m_message; }

private:
    int m_line, m_column;
    std::string m_message;
};

/// Throws JsonSyntaxError at the first position where a text is not JSON [RFC 8259] with comments, repeats a member of
/// an object, or is nested deeper than 32 levels.
void checkJsonSyntax(const std::string& text);

}  // namespace bullet_fem

// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "tools/scene/json_syntax.h"

#include <cctype>
#include <cmath>
#include <cstdlib>
#include <map>

#include "fem/common/message.h"

namespace bullet_fem
{
namespace
{

constexpr int kDeepestLevel = 32;          // scenes need six; messages print values recursively
constexpr std::size_t kLongestShown = 40;  // of a name or word in a message [bytes]

std::string quoted(const std::string& name)
{
    return '"' + name.substr(0, kLongestShown) + '"';
}

bool isWordLetter(char c)
{
    return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_' || c == '$';
}

bool isDigit(char c)
{
    return c >= '0' && c <= '9';
}

/// Length of the UTF-8 character at a position [bytes]; 0 if it is invalid.
std::size_t utf8Length(const std::string& text, std::size_t at)
{
    const auto byte = [&](std::size_t k) { return k < text.size() ? static_cast<unsigned char>(text[k]) : 0u; };
    const unsigned first = byte(at);
    if (first < 0x80) return 1;
    const std::size_t length = first >= 0xf0 ? 4 : first >= 0xe0 ? 3 : 2;
    if (first < 0xc2 || first > 0xf4) return 0;
    for (std::size_t k = 1; k < length; ++k)
        if ((byte(at + k) & 0xc0u) != 0x80) return 0;
    const unsigned second = byte(at + 1);
    const bool isOverlong = (first == 0xe0 && second < 0xa0) || (first == 0xf0 && second < 0x90);
    const bool isOutside = (first == 0xed && second > 0x9f) || (first == 0xf4 && second > 0x8f);
    return isOverlong || isOutside ? 0 : length;
}

/// A recursive descent parser that throws at the first error.
class JsonChecker
{
public:
    explicit JsonChecker(const std::string& text) : m_text(text)
    {
        if (text.compare(0, 3, "\xef\xbb\xbf") == 0) m_at = m_lineStart = 3;  // a byte order mark
    }

    void check()
    {
        skipSpace();
        if (isOver()) fail("the file is empty; a scene begins with '{'");
        readValue("");
        skipSpace();
        if (!isOver()) expected("the end of the file");
    }

private:
    /// Position of a token's start.
    struct Place
    {
        std::size_t m_at, m_lineStart;
        int m_line;
    };

    bool isOver() const { return m_at >= m_text.size(); }
    char now() const { return isOver() ? '\0' : m_text[m_at]; }
    bool isAt(char c) const { return !isOver() && m_text[m_at] == c; }
    Place here() const { return {m_at, m_lineStart, m_line}; }
    void restoreBest(const Place& place)
    {
        m_at = place.m_at;
        m_lineStart = place.m_lineStart;
        m_line = place.m_line;
    }
    void advance()
    {
        if (m_text[m_at++] != '\n') return;
        m_lineStart = m_at;
        ++m_line;
    }
    bool take(char c)
    {
        if (!isAt(c)) return false;
        advance();
        return true;
    }

    [[noreturn]] void fail(const std::string& message) const
    {
        int column = 1;
        for (std::size_t k = m_lineStart; k < m_at; ++k)
            column += (static_cast<unsigned char>(m_text[k]) & 0xc0u) != 0x80;
        throw JsonSyntaxError(m_line, column, message);
    }
    [[noreturn]] void expected(const std::string& what, const std::string& remedy = "") const
    {
        fail("expected " + what + ", found " + found() + remedy);
    }

    /// The character or word at the present position, as shown in messages.
    std::string found() const
    {
        if (isOver()) return "the end of the file";
        const char c = now();
        if (c == '\n' || c == '\r') return "the end of the line";
        std::size_t length = 0;
        while (m_at + length < m_text.size() && length < kLongestShown && isWordLetter(m_text[m_at + length])) ++length;
        if (length == 0) length = utf8Length(m_text, m_at);
        const auto byte = static_cast<unsigned char>(c);
        if (length == 0 || byte < 0x20 || byte == 0x7f) return message("the byte ", int(byte));
        return "'" + m_text.substr(m_at, length) + "'";
    }

    void skipSpace()
    {
        while (!isOver())
        {
            if (now() == ' ' || now() == '\t' || now() == '\n' || now() == '\r')
                advance();
            else if (now() == '/')
                skipComment();
            else
                return;
        }
    }

    void skipComment()
    {
        const Place start = here();
        advance();
        if (take('/'))
        {
            while (!isOver() && now() != '\n') advance();
            return;
        }
        if (!take('*')) expected("'/' or '*' after '/', which begins a comment");
        while (m_text.compare(m_at, 2, "*/") != 0)
        {
            if (isOver())
            {
                restoreBest(start);
                fail("expected '*/' after '/*', which begins a comment, found the end of the file");
            }
            advance();
        }
        advance();
        advance();
    }

    /// `whose` is the name of the value's member; empty for the document.
    void readValue(const std::string& whose)
    {
        switch (now())
        {
            case '{':
                return readNested([&] { readObject(); });
            case '[':
                return readNested([&] { readArray(whose); });
            case '"':
                readText();
                return;
            default:
                if (isDigit(now()) || isAt('-')) return readNumber();
                readWord(whose);
        }
    }

    template <class Read>
    void readNested(const Read& read)
    {
        if (++m_depth > kDeepestLevel) fail(message("it is nested deeper than ", kDeepestLevel, " levels"));
        read();
        --m_depth;
    }

    void readObject()
    {
        const int firstLine = m_line;
        std::map<std::string, int> members;  // lines of the members' names
        advance();
        skipSpace();
        if (take('}')) return;
        for (;;)
        {
            if (!isAt('"')) expected("a member's name in double quotes", remedyOfName());
            const Place nameStart = here();
            const std::string name = readText();
            const auto [earlier, isNew] = members.try_emplace(name, nameStart.m_line);
            if (!isNew)
            {
                restoreBest(nameStart);
                fail(message("the member ", quoted(name), " is there twice in one object, first in line ",
                             earlier->second, "; give every member once"));
            }
            skipSpace();
            if (!take(':')) expected("a colon after the name " + quoted(name));
            skipSpace();
            readValue(name);
            skipSpace();
            if (take('}')) return;
            if (!take(','))
                expected("a comma or '}' after the value of " + quoted(name), openedIn("object", firstLine));
            skipSpace();
        }
    }

    void readArray(const std::string& whose)
    {
        const int firstLine = m_line;
        advance();
        skipSpace();
        if (take(']')) return;
        for (int count = 1;; ++count)
        {
            if (isAt(']')) expected("a value", kTrailingComma);
            readValue(whose);
            skipSpace();
            if (take(']')) return;
            if (!take(','))
                expected(
                    message("a comma or ']' after value ", count, " of ", whose.empty() ? "the array" : quoted(whose)),
                    openedIn("array", firstLine));
            skipSpace();
        }
    }

    // Names the line of the opening bracket if the text ends too early.
    std::string openedIn(const char* what, int line) const
    {
        return isOver() ? message("; the ", what, " begins in line ", line) : "";
    }

    /// Reads a quoted text; escapes stay undecoded.
    std::string readText()
    {
        advance();
        const std::size_t start = m_at;
        while (!isAt('"'))
        {
            const auto byte = static_cast<unsigned char>(now());
            if (isOver() || now() == '\n' || now() == '\r') expected("'\"' at the end of the text");
            if (byte < 0x20) expected("an escape such as \\t in a text");
            if (now() == '\\')
            {
                readEscape();
                continue;
            }
            const std::size_t length = utf8Length(m_text, m_at);
            if (length == 0) expected("a character of UTF-8", "; save the file as UTF-8");
            m_at += length;
        }
        advance();
        return m_text.substr(start, m_at - 1 - start);
    }

    void readEscape()
    {
        advance();
        if (take('u'))
        {
            const unsigned code = readHexadecimal();
            if (code < 0xd800 || code > 0xdfff) return;
            const bool isPaired = code < 0xdc00 && take('\\') && take('u');
            const unsigned second = isPaired ? readHexadecimal() : 0;
            if (second < 0xdc00 || second > 0xdfff) expected("the second half of a surrogate pair, \\udc00 to \\udfff");
            return;
        }
        if (isOver() || std::string("\"\\/bfnrt").find(now()) == std::string::npos)
            expected("one of \" \\ / b f n r t u after a backslash", "; write \\\\ for a backslash");
        advance();
    }

    unsigned readHexadecimal()
    {
        const std::size_t start = m_at;
        for (int k = 0; k < 4; ++k, advance())
            if (isOver() || std::isxdigit(static_cast<unsigned char>(now())) == 0)
                expected("four hexadecimal digits after \\u");
        return static_cast<unsigned>(std::strtoul(m_text.substr(start, 4).c_str(), nullptr, 16));
    }

    void readNumber()
    {
        const Place start = here();
        take('-');
        if (take('0'))
        {
            if (isDigit(now())) expected("'.' after a leading 0");
        }
        else
            readDigits("after '-'");
        if (take('.')) readDigits("after the decimal point");
        if (take('e') || take('E'))
        {
            if (!take('+')) take('-');
            readDigits("in the exponent");
        }
        const std::string number = m_text.substr(start.m_at, m_at - start.m_at);
        if (isWordLetter(now()) || isAt('.')) expected("the end of the number " + number.substr(0, kLongestShown));
        if (std::isfinite(std::strtod(number.c_str(), nullptr))) return;
        restoreBest(start);
        fail("expected a number of at most 1.8e308, found a larger one");
    }

    void readDigits(const char* where)
    {
        if (!isDigit(now())) expected(std::string("a digit ") + where);
        while (isDigit(now())) advance();
    }

    void readWord(const std::string& whose)
    {
        for (const char* word : {"true", "false", "null"})
        {
            const std::size_t length = std::char_traits<char>::length(word);
            const bool isEnd = m_at + length >= m_text.size() || !isWordLetter(m_text[m_at + length]);
            if (m_text.compare(m_at, length, word) != 0 || !isEnd) continue;
            m_at += length;
            return;
        }
        expected(whose.empty() ? "a value" : "a value of " + quoted(whose), remedyOfWord());
    }

    const char* remedyOfWord() const
    {
        const std::string word = found();
        if (word == "'NaN'" || word == "'nan'" || word == "'Infinity'" || word == "'inf'")
            return "; JSON has finite numbers alone";
        if (word == "'True'" || word == "'False'" || word == "'None'") return "; write true, false or null";
        if (word == "'''") return "; texts are in double quotes";
        if (word == "'+'" || word == "'.'") return "; a number begins with a digit or '-'";
        return isWordLetter(now()) ? "; texts are in double quotes" : "";
    }

    const char* remedyOfName() const
    {
        if (isAt('}')) return kTrailingComma;
        return isDigit(now()) ? "; decimals are written with a point" : "";
    }

    static constexpr const char* kTrailingComma = "; remove the comma before it";

    const std::string& m_text;
    std::size_t m_at = 0, m_lineStart = 0;
    int m_line = 1, m_depth = 0;
};

}  // namespace

JsonSyntaxError::JsonSyntaxError(int line, int column, const std::string& message)
    : std::runtime_error(bullet_fem::message("line ", line, ", column ", column, ": ", message)),
      m_line(line),
      m_column(column),
      m_message(message)
{
}

void checkJsonSyntax(const std::string& text)
{
    JsonChecker(text).check();
}

}  // namespace bullet_fem

// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// Text that is not JSON is rejected with the position, the expected and the found text.
#include "tools/scene/json_syntax.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <random>

#include "io/temporary_folder.h"
#include "tools/scene/scene_reader.h"
#include "tools/scene_samples.h"

namespace bullet_fem
{
namespace
{

struct BadText
{
    const char* m_test;
    const char* m_text;
    int m_line, m_column;
    const char* m_message;
};

void PrintTo(const BadText& bad, std::ostream* out)
{
    *out << bad.m_text;
}

class BadJson : public testing::TestWithParam<BadText>
{
};

TEST_P(BadJson, IsRejectedWithPlaceAndExpectation)
{
    const BadText& bad = GetParam();
    try
    {
        checkJsonSyntax(bad.m_text);
        FAIL() << "it was taken";
    }
    catch (const JsonSyntaxError& error)
    {
        EXPECT_EQ(error.line(), bad.m_line);
        EXPECT_EQ(error.column(), bad.m_column);
        EXPECT_EQ(error.message(), bad.m_message);
        EXPECT_EQ(error.what(), "line " + std::to_string(bad.m_line) + ", column " + std::to_string(bad.m_column) +
                                    ": " + bad.m_message);
    }
}

const BadText kBadStructures[] = {
    {"Nothing", "", 1, 1, "the file is empty; a scene begins with '{'"},
    {"Space", " \n\n ", 3, 2, "the file is empty; a scene begins with '{'"},
    {"ByteOrderMark", "\xef\xbb\xbf", 1, 1, "the file is empty; a scene begins with '{'"},
    {"NoComma", "{\n  \"young\": 1\n  \"poisson\": 0 }", 3, 3,
     "expected a comma or '}' after the value of \"young\", found '\"'"},
    {"NoCommaInAnArray", "{ \"size\": [1, 2 3] }", 1, 17,
     "expected a comma or ']' after value 2 of \"size\", found '3'"},
    {"NoCommaInTheDocument", "[1 2]", 1, 4, "expected a comma or ']' after value 1 of the array, found '2'"},
    {"NoColon", "{ \"step\" 1 }", 1, 10, "expected a colon after the name \"step\", found '1'"},
    {"NoValue", "{ \"step\": }", 1, 11, "expected a value of \"step\", found '}'"},
    {"NoName", "{ 1: 2 }", 1, 3,
     "expected a member's name in double quotes, found '1'; decimals are written with a point"},
    {"NameWithoutQuotes", "{ step: 2 }", 1, 3, "expected a member's name in double quotes, found 'step'"},
    {"DecimalComma", "{ \"step\": 0,01 }", 1, 13,
     "expected a member's name in double quotes, found '01'; decimals are written with a point"},
    {"CommaAtTheEnd", "{ \"step\": 1, }", 1, 14,
     "expected a member's name in double quotes, found '}'; remove the comma before it"},
    {"CommaAtTheEndOfAnArray", "[1, ]", 1, 5, "expected a value, found ']'; remove the comma before it"},
    {"CommaFirst", "[, 1]", 1, 2, "expected a value, found ','"},
    {"OtherBracket", "{ \"a\": [1, 2} }", 1, 13, "expected a comma or ']' after value 2 of \"a\", found '}'"},
    {"MoreAfterTheEnd", "{}}", 1, 3, "expected the end of the file, found '}'"},
    {"EndOfAnObject", "{\n \"a\": {\n \"b\": 1\n", 4, 1,
     "expected a comma or '}' after the value of \"b\", found the end of the file; the object begins in line 2"},
    {"EndOfAnArray", "[\n 1", 2, 3,
     "expected a comma or ']' after value 1 of the array, found the end of the file; the array begins in line 1"},
    {"EndAfterAName", "{ \"a\"", 1, 6, "expected a colon after the name \"a\", found the end of the file"},
    {"EndAfterAColon", "{ \"a\":", 1, 7, "expected a value of \"a\", found the end of the file"},
    {"EndInAText", "{ \"a\": \"b", 1, 10, "expected '\"' at the end of the text, found the end of the file"},
    {"EndInAComment", "{} /* ", 1, 4, "expected '*/' after '/*', which begins a comment, found the end of the file"},
    {"HalfAComment", "{} / x", 1, 5, "expected '/' or '*' after '/', which begins a comment, found ' '"},
    {"HashComment", "# x\n{}", 1, 1, "expected a value, found '#'"},
    {"AMemberTwice", "{ \"a\": 1,\n \"b\": 2,\n \"a\": 3 }", 3, 2,
     "the member \"a\" is there twice in one object, first in line 1; give every member once"},
};

const BadText kBadTokens[] = {
    {"NaN", "{ \"step\": NaN }", 1, 11, "expected a value of \"step\", found 'NaN'; JSON has finite numbers alone"},
    {"Infinity", "[Infinity]", 1, 2, "expected a value, found 'Infinity'; JSON has finite numbers alone"},
    {"NegativeInfinity", "[-Infinity]", 1, 3, "expected a digit after '-', found 'Infinity'"},
    {"True", "[True]", 1, 2, "expected a value, found 'True'; write true, false or null"},
    {"LongerThanTrue", "[trueish]", 1, 2, "expected a value, found 'trueish'; texts are in double quotes"},
    {"SingleQuotes", "['a']", 1, 2, "expected a value, found '''; texts are in double quotes"},
    {"WithoutQuotes", "[jelly]", 1, 2, "expected a value, found 'jelly'; texts are in double quotes"},
    {"Plus", "[+1]", 1, 2, "expected a value, found '+'; a number begins with a digit or '-'"},
    {"PointFirst", "[.5]", 1, 2, "expected a value, found '.'; a number begins with a digit or '-'"},
    {"PointLast", "[5.]", 1, 4, "expected a digit after the decimal point, found ']'"},
    {"LeadingZero", "[05]", 1, 3, "expected '.' after a leading 0, found '5'"},
    {"Exponent", "[1e]", 1, 4, "expected a digit in the exponent, found ']'"},
    {"Unit", "[12px]", 1, 4, "expected the end of the number 12, found 'px'"},
    {"TooLarge", "[1, 1e999]", 1, 5, "expected a number of at most 1.8e308, found a larger one"},
    {"LineInAText", "[\"a\nb\"]", 1, 4, "expected '\"' at the end of the text, found the end of the line"},
    {"TabInAText", "[\"a\tb\"]", 1, 4, "expected an escape such as \\t in a text, found the byte 9"},
    {"Escape", "[\"C:\\dir\"]", 1, 6,
     "expected one of \" \\ / b f n r t u after a backslash, found 'dir'; write \\\\ for a backslash"},
    {"Hexadecimal", "[\"\\u12g4\"]", 1, 7, "expected four hexadecimal digits after \\u, found 'g4'"},
    {"HalfASurrogatePair", "[\"\\ud800\"]", 1, 9,
     "expected the second half of a surrogate pair, \\udc00 to \\udfff, found '\"'"},
    {"NotUtf8", "[\"\xc3\xa4\xff\"]", 1, 4,
     "expected a character of UTF-8, found the byte 255; save the file as UTF-8"},
    {"OverlongUtf8", "[\"\xc0\x80\"]", 1, 3,
     "expected a character of UTF-8, found the byte 192; save the file as UTF-8"},
    {"ColumnsAreCharacters", "[\"\xc3\xa4\xe2\x82\xac\", x]", 1, 8,
     "expected a value, found 'x'; texts are in double quotes"},
};

std::string badTextName(const testing::TestParamInfo<BadText>& info)
{
    return info.param.m_test;
}

INSTANTIATE_TEST_SUITE_P(Structure, BadJson, testing::ValuesIn(kBadStructures), badTextName);
INSTANTIATE_TEST_SUITE_P(Values, BadJson, testing::ValuesIn(kBadTokens), badTextName);

TEST(JsonSyntax, TakesAllOfJsonAndComments)
{
    for (const char* text :
         {"{}", "[]", "\xef\xbb\xbf{ }", "// a\n{ /* b\n */ \"a\" : [ 1 , -0.5e+3, 0, 1E-2, true, false, null ] } // c",
          "\"\\\" \\\\ \\/ \\b \\f \\n \\r \\t \\u00e4 \\ud83d\\ude00 \xf0\x9f\x98\x80\"", "3", "\r\n[\r\n]\r\n"})
        EXPECT_NO_THROW(checkJsonSyntax(text)) << text;
}

TEST(JsonSyntax, LimitsTheDepth)
{
    const auto nested = [](int depth) { return std::string(depth, '[') + std::string(depth, ']'); };
    EXPECT_NO_THROW(checkJsonSyntax(nested(32)));
    for (const std::string& text : {nested(33), std::string(1000000, '[')}) try
        {
            checkJsonSyntax(text);
            ADD_FAILURE() << "it was taken";
        }
        catch (const JsonSyntaxError& error)
        {
            EXPECT_STREQ(error.what(), "line 1, column 33: it is nested deeper than 32 levels");
        }
}

// The checker rejects all that the library rejects; otherwise the library's message would appear.
TEST(JsonSyntax, AgreesWithTheLibraryOnDamagedScenes)
{
    static const std::string pool = "{}[]\",:0123456789.-+eE \n\\/*truefalsn\x7f\xff\xc3\xed";
    std::mt19937 random(1);
    int taken = 0;
    for (int run = 0; run < 5000; ++run)
    {
        std::string text = run % 2 ? fullScene() : otherScene();
        for (int k = 1 + static_cast<int>(random() % 3); k > 0; --k)
            text[random() % text.size()] = pool[random() % pool.size()];
        std::string why;
        try
        {
            checkJsonSyntax(text);
            ++taken;
        }
        catch (const JsonSyntaxError& error)
        {
            why = error.message();
            if (why.find("twice") != std::string::npos) continue;  // the library accepts duplicate members
        }
        EXPECT_EQ(nlohmann::json::accept(text, true), why.empty()) << why << '\n' << text;
    }
    EXPECT_GT(taken, 500);
    EXPECT_LT(taken, 4500);
}

TEST(JsonSyntax, FaultsOfASceneFileBeginWithItsNameLineAndColumn)
{
    const TemporaryFolder folder;
    const std::string path = folder.write("scene.json", "{\n  \"step\": 0.01\n  \"seconds\": 1 }");
    try
    {
        readScene(path);
        FAIL() << "it was taken";
    }
    catch (const std::runtime_error& error)
    {
        EXPECT_EQ(error.what(), path + ":3:3: expected a comma or '}' after the value of \"step\", found '\"'");
    }
}

}  // namespace
}  // namespace bullet_fem

// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "tools/scene/json_cursor.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "fem/common/message.h"
#include "tools/scene/json_syntax.h"

namespace bullet_fem
{
namespace
{

std::string shown(const nlohmann::json& value)
{
    // Invalid UTF-8 is shown with replacement characters.
    const std::string text = value.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
    return text.size() <= 40 ? text : text.substr(0, 37) + "...";
}

std::string told(const JsonRange& range)
{
    const bool endless = range.m_high >= 1e30;
    if (endless && range.m_low <= -1e30) return "a number";
    if (endless) return message("a number ", range.m_openBelow ? "above " : "of at least ", range.m_low);
    return message("a number in ", range.m_openBelow ? "(" : "[", range.m_low, ", ", range.m_high, "]");
}

std::string listed(std::initializer_list<const char*> names)
{
    std::string all;
    for (const char* name : names) all += (all.empty() ? "" : ", ") + std::string(name);
    return all;
}

}  // namespace

nlohmann::json parseJson(const std::string& text)
{
    checkJsonSyntax(text);
    return nlohmann::json::parse(text, nullptr, true, true);  // comments are allowed
}

void JsonCursor::fail(const std::string& what) const
{
    throw std::runtime_error((m_path.empty() ? "the document" : m_path) + " " + what);
}

void JsonCursor::expected(const std::string& what) const
{
    fail("is " + shown(*m_value) + "; it must be " + what);
}

void JsonCursor::onlyMembers(std::initializer_list<const char*> names) const
{
    if (!m_value->is_object()) expected("an object with " + listed(names));
    for (const auto& [name, value] : m_value->items())
        if (std::find(names.begin(), names.end(), name) == names.end())
            fail("has a member '" + name.substr(0, 40) + "', which is not known; those that are: " + listed(names));
}

bool JsonCursor::isObject() const
{
    return m_value->is_object();
}

bool JsonCursor::isArray() const
{
    return m_value->is_array();
}

bool JsonCursor::has(const char* name) const
{
    return m_value->is_object() && m_value->contains(name);
}

JsonCursor JsonCursor::operator[](const char* name) const
{
    if (!has(name)) fail(message("lacks '", name, "'"));
    return {(*m_value)[name], m_path.empty() ? name : m_path + "." + name};
}

double JsonCursor::number(const JsonRange& range) const
{
    const double value = m_value->is_number() ? m_value->get<double>() : std::nan("");
    const bool inside = (range.m_openBelow ? value > range.m_low : value >= range.m_low) && value <= range.m_high;
    if (!inside) expected(told(range));
    return value;
}

int JsonCursor::integer(int low, int high) const
{
    const double value = m_value->is_number() ? m_value->get<double>() : std::nan("");
    if (!(value >= low && value <= high && value == std::floor(value)))
        expected(message("a whole number in [", low, ", ", high, "]"));
    return static_cast<int>(value);
}

bool JsonCursor::flag() const
{
    if (!m_value->is_boolean()) expected("true or false");
    return m_value->get<bool>();
}

std::string JsonCursor::text() const
{
    if (!m_value->is_string() || m_value->get_ref<const std::string&>().empty())
        expected("a text in quotes, not empty");
    return m_value->get<std::string>();
}

Vec3 JsonCursor::vector(const JsonRange& range) const
{
    if (!m_value->is_array() || m_value->size() != 3) expected("an array of three numbers");
    const std::vector<JsonCursor> parts = items();
    return {parts[0].number(range), parts[1].number(range), parts[2].number(range)};
}

Vec3 JsonCursor::direction() const
{
    const Vec3 value = vector({-1e9, 1e9});
    if (!(norm(value) > 1e-9)) fail("is " + shown(*m_value) + "; it must have a length");
    return value;
}

std::size_t JsonCursor::choice(std::initializer_list<const char*> texts) const
{
    const auto found = m_value->is_string()
                           ? std::find(texts.begin(), texts.end(), m_value->get_ref<const std::string&>())
                           : texts.end();
    if (found == texts.end()) expected("one of: " + listed(texts));
    return static_cast<std::size_t>(found - texts.begin());
}

std::vector<JsonCursor> JsonCursor::items() const
{
    if (!m_value->is_array()) expected("an array, in []");
    std::vector<JsonCursor> result;
    for (const nlohmann::json& item : *m_value) result.emplace_back(item, message(m_path, "[", result.size(), "]"));
    return result;
}

std::vector<JsonCursor> JsonCursor::members(std::vector<std::string>& names) const
{
    if (!m_value->is_object()) expected("an object, in {}");
    std::vector<JsonCursor> result;
    for (const auto& [name, value] : m_value->items())
    {
        names.push_back(name);
        result.emplace_back(value, m_path + "." + name);
    }
    return result;
}

void JsonCursor::read(const char* name, const JsonRange& range, double& value) const
{
    if (has(name)) value = (*this)[name].number(range);
}

void JsonCursor::read(const char* name, int low, int high, int& value) const
{
    if (has(name)) value = (*this)[name].integer(low, high);
}

void JsonCursor::read(const char* name, bool& value) const
{
    if (has(name)) value = (*this)[name].flag();
}

void JsonCursor::read(const char* name, std::string& value) const
{
    if (has(name)) value = (*this)[name].text();
}

void JsonCursor::read(const char* name, const JsonRange& range, Vec3& value) const
{
    if (has(name)) value = (*this)[name].vector(range);
}

void JsonCursor::readDirection(const char* name, Vec3& value) const
{
    if (has(name)) value = (*this)[name].direction();
}

void JsonCursor::forEach(const char* name, const std::function<void(const JsonCursor&)>& each) const
{
    if (!has(name)) return;
    for (const JsonCursor& item : (*this)[name].items()) each(item);
}

}  // namespace bullet_fem

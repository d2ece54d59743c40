// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <functional>
#include <initializer_list>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "bullet_fem/fem/common/vec3.h"

namespace bullet_fem
{

/// Parses a JSON document with comments. Throws the exceptions of checkJsonSyntax.
nlohmann::json parseJson(const std::string& text);

/// Range of a number.
struct JsonRange
{
    double m_low, m_high;
    bool m_openBelow = false;  ///< excludes m_low
};

/// A value in a JSON document, which must outlive it, with its path ("softBodies[1].mesh") for messages. All reads are
/// checked; invalid data throws std::runtime_error with the path, the value found and the value expected.
class JsonCursor
{
public:
    JsonCursor(const nlohmann::json& value, std::string path) : m_value(&value), m_path(std::move(path)) {}

    [[noreturn]] void fail(const std::string& what) const;
    /// Throws: the value found must be `what`.
    [[noreturn]] void expected(const std::string& what) const;

    /// Requires an object without other members than these.
    void onlyMembers(std::initializer_list<const char*> names) const;
    bool isObject() const;
    bool isArray() const;
    bool has(const char* name) const;
    JsonCursor operator[](const char* name) const;  ///< a required member

    double number(const JsonRange& range) const;
    int integer(int low, int high) const;
    bool flag() const;
    std::string text() const;                                            ///< not empty
    Vec3 vector(const JsonRange& range) const;                           ///< an array of three numbers
    Vec3 direction() const;                                              ///< a vector that is not 0
    std::size_t choice(std::initializer_list<const char*> texts) const;  ///< index of the text that equals the value
    std::vector<JsonCursor> items() const;                               ///< of an array
    std::vector<JsonCursor> members(std::vector<std::string>& names) const;  ///< of an object, and their names

    /// Sets `value` if the member exists.
    void read(const char* name, const JsonRange& range, double& value) const;
    void read(const char* name, int low, int high, int& value) const;
    void read(const char* name, bool& value) const;
    void read(const char* name, std::string& value) const;
    void read(const char* name, const JsonRange& range, Vec3& value) const;
    void readDirection(const char* name, Vec3& value) const;
    /// Calls `each` for each item of the array, if the member exists.
    void forEach(const char* name, const std::function<void(const JsonCursor&)>& each) const;

private:
    const nlohmann::json* m_value;
    std::string m_path;
};

}  // namespace bullet_fem

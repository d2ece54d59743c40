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

/// The document that a text is, with comments allowed. Throws what checkJsonSyntax throws.
nlohmann::json parseJson(const std::string& text);

/// What a number must lie in.
struct JsonRange
{
    double m_low, m_high;
    bool m_openBelow = false;  ///< m_low itself is not allowed
};

/// A place in a JSON document, which must live longer, with its path ("softBodies[1].mesh") for messages. Everything
/// that is read is checked; what is wrong throws std::runtime_error that names the path, what is there, and what is
/// expected.
class JsonCursor
{
public:
    JsonCursor(const nlohmann::json& value, std::string path) : m_value(&value), m_path(std::move(path)) {}

    [[noreturn]] void fail(const std::string& what) const;
    /// Fails, saying what is here and that it must be `what`.
    [[noreturn]] void expected(const std::string& what) const;

    /// This must be an object with no other members than these.
    void onlyMembers(std::initializer_list<const char*> names) const;
    bool isObject() const;
    bool isArray() const;
    bool has(const char* name) const;
    JsonCursor operator[](const char* name) const;  ///< a member that must be there

    double number(const JsonRange& range) const;
    int integer(int low, int high) const;
    bool flag() const;
    std::string text() const;                                                ///< not empty
    Vec3 vector(const JsonRange& range) const;                               ///< an array of three numbers
    Vec3 direction() const;                                                  ///< a vector that is not 0
    std::size_t choice(std::initializer_list<const char*> texts) const;      ///< which of the texts it is
    std::vector<JsonCursor> items() const;                                   ///< an array's
    std::vector<JsonCursor> members(std::vector<std::string>& names) const;  ///< an object's, and what they are called

    /// Set `value` if the member is there.
    void read(const char* name, const JsonRange& range, double& value) const;
    void read(const char* name, int low, int high, int& value) const;
    void read(const char* name, bool& value) const;
    void read(const char* name, std::string& value) const;
    void read(const char* name, const JsonRange& range, Vec3& value) const;
    void readDirection(const char* name, Vec3& value) const;
    /// Calls `each` for every item of the array, if the member is there.
    void forEach(const char* name, const std::function<void(const JsonCursor&)>& each) const;

private:
    const nlohmann::json* m_value;
    std::string m_path;
};

}  // namespace bullet_fem

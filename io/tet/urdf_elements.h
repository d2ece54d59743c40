// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <tinyxml2.h>

#include <array>
#include <filesystem>
#include <limits>
#include <string>

#include "bullet_fem/io/urdf_deformable.h"
#include "fem/common/message.h"
#include "fem/common/reason.h"

namespace bullet_fem
{

// Elements and attributes of URDF files. All functions throw std::runtime_error naming line, contents and expectation.

struct UrdfRange
{
    double m_low;
    bool m_openBelow;
    const char* m_says;
};
constexpr UrdfRange kPositive = {0, true, "a number above 0"};
constexpr UrdfRange kNotNegative = {0, false, "a number of at least 0"};
constexpr UrdfRange kFinite = {-std::numeric_limits<double>::max(), false, "a finite number"};

[[noreturn]] void failInUrdf(const tinyxml2::XMLElement& where, const std::string& what);
const char* attributeOf(const tinyxml2::XMLElement& element, const char* name);

/// `count` numbers of an attribute.
void numbersIn(const tinyxml2::XMLElement& element, const char* attribute, const UrdfRange& range, double* numbers,
               int count);
double numberIn(const tinyxml2::XMLElement& element, const char* attribute, const UrdfRange& range);

/// Sets a value from `<name value="..."/>` if that exists.
void readValue(const tinyxml2::XMLElement& parent, const char* name, const UrdfRange& range, double& value);

/// The file that the attribute `filename` names: beside the URDF file, or in the four folders above.
std::string findMesh(const tinyxml2::XMLElement& element, const std::filesystem::path& urdf);

/// A `<deformable>`.
UrdfDeformable readDeformable(const tinyxml2::XMLElement& block, const std::filesystem::path& urdf);

/// Calls read(robot) for the element `<robot>` of a file, and returns its result. Exceptions name the file.
template <class Read>
auto readUrdf(const std::string& path, const Read& read)
{
    try
    {
        if (!std::filesystem::is_regular_file(path)) throw std::runtime_error("there is no such file");
        tinyxml2::XMLDocument document;
        if (document.LoadFile(path.c_str()) != tinyxml2::XML_SUCCESS)
            throw std::runtime_error(
                message("line ", document.ErrorLineNum(), ": it is not XML (", document.ErrorName(), ")"));
        const tinyxml2::XMLElement* robot = document.FirstChildElement("robot");
        if (!robot) throw std::runtime_error("there is no <robot> element; a URDF file has one around everything");
        return read(*robot);
    }
    catch (const std::exception& error)
    {
        throw std::runtime_error("cannot read the URDF file '" + path + "': " + reasonOf(error));
    }
}

}  // namespace bullet_fem

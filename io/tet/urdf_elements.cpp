// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "io/tet/urdf_elements.h"

#include <cmath>
#include <stdexcept>

#include "io/text/number_text.h"

namespace bullet_fem
{
namespace
{

using tinyxml2::XMLElement;

std::string withoutScheme(std::string name)
{
    for (const char* scheme : {"package://", "model://"})
        if (name.rfind(scheme, 0) == 0) return name.substr(std::string(scheme).size());
    return name;
}

double numberOf(std::string_view word, const UrdfRange& range)
{
    try
    {
        const double value = parseNumber<double>(word, range.m_says);
        const bool inside = std::isfinite(value) && (range.m_openBelow ? value > range.m_low : value >= range.m_low);
        if (inside) return value;
    }
    catch (const std::runtime_error&)  // named by the caller, with its place
    {
    }
    return std::numeric_limits<double>::quiet_NaN();
}

}  // namespace

void failInUrdf(const XMLElement& where, const std::string& what)
{
    throw std::runtime_error(message("line ", where.GetLineNum(), ", <", where.Name(), ">: ", what));
}

const char* attributeOf(const XMLElement& element, const char* name)
{
    const char* text = element.Attribute(name);
    if (!text) failInUrdf(element, message("the attribute '", name, "' is missing"));
    return text;
}

void numbersIn(const XMLElement& element, const char* attribute, const UrdfRange& range, double* numbers, int count)
{
    const char* text = attributeOf(element, attribute);
    std::string_view rest = text;
    bool good = true;
    for (int k = 0; k < count; ++k)
    {
        numbers[k] = numberOf(takeWord(rest), range);
        good = good && std::isfinite(numbers[k]);
    }
    if (good && takeWord(rest).empty()) return;
    const std::string expected = count == 1 ? range.m_says : message(count, " numbers, each ", range.m_says);
    failInUrdf(element, message(attribute, " is '", printable(text), "'; it must be ", expected));
}

double numberIn(const XMLElement& element, const char* attribute, const UrdfRange& range)
{
    double number = 0;
    numbersIn(element, attribute, range, &number, 1);
    return number;
}

void readValue(const XMLElement& parent, const char* name, const UrdfRange& range, double& value)
{
    if (const XMLElement* element = parent.FirstChildElement(name)) value = numberIn(*element, "value", range);
}

std::string findMesh(const XMLElement& element, const std::filesystem::path& urdf)
{
    const std::string given = attributeOf(element, "filename");
    const std::filesystem::path name = withoutScheme(given);
    std::filesystem::path folder = urdf.parent_path();
    for (int up = 0; up <= 4; ++up, folder /= "..")
    {
        std::error_code ignored;
        const std::filesystem::path candidate = folder / name;  // the name itself if it is absolute
        if (std::filesystem::is_regular_file(candidate, ignored)) return candidate.lexically_normal().string();
    }
    failInUrdf(element,
               "the file '" + given + "' is neither beside the URDF file nor in the four folders above; put it there");
}

}  // namespace bullet_fem

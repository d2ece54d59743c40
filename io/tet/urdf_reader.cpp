// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include <tinyxml2.h>

#include <cmath>
#include <filesystem>
#include <limits>
#include <stdexcept>

#include "bullet_fem/io/urdf_deformable.h"
#include "fem/common/message.h"
#include "fem/common/reason.h"
#include "io/text/number_text.h"

namespace bullet_fem
{
namespace
{

using tinyxml2::XMLElement;

[[noreturn]] void fail(const XMLElement& where, const std::string& what)
{
    throw std::runtime_error(message("line ", where.GetLineNum(), ", <", where.Name(), ">: ", what));
}

const char* attributeOf(const XMLElement& element, const char* name)
{
    const char* text = element.Attribute(name);
    if (!text) fail(element, message("the attribute '", name, "' is missing"));
    return text;
}

struct Range
{
    double m_low;
    bool m_openBelow;
    const char* m_says;
};
constexpr Range kPositive = {0, true, "a number above 0"};
constexpr Range kNotNegative = {0, false, "a number of at least 0"};
constexpr Range kFinite = {-std::numeric_limits<double>::max(), false, "a finite number"};

double numberIn(const XMLElement& element, const char* attribute, const Range& range)
{
    const char* text = attributeOf(element, attribute);
    std::string_view rest = text;
    const std::string_view word = takeWord(rest);
    double value = std::numeric_limits<double>::quiet_NaN();
    try
    {
        value = parseNumber<double>(word, range.m_says);
    }
    catch (const std::runtime_error&)  // named below, with its place
    {
    }
    const bool inside = std::isfinite(value) && (range.m_openBelow ? value > range.m_low : value >= range.m_low);
    if (!inside || !takeWord(rest).empty())
        fail(element, message(attribute, " is '", printable(text), "'; it must be ", range.m_says));
    return value;
}

/// Sets a value from `<name value="..."/>` if that exists.
void readValue(const XMLElement& parent, const char* name, const Range& range, double& value)
{
    if (const XMLElement* element = parent.FirstChildElement(name)) value = numberIn(*element, "value", range);
}

double massOf(const XMLElement& block)
{
    const XMLElement* inertial = block.FirstChildElement("inertial");
    if (!inertial) fail(block, "an <inertial> with a <mass> is missing");
    const XMLElement* mass = inertial->FirstChildElement("mass");
    if (!mass) fail(*inertial, "a <mass> is missing");
    return numberIn(*mass, "value", kPositive);
}

/// Adds the moduli of one law; damping is averaged with weights mu.
void addLaw(const XMLElement& law, UrdfDeformable& result)
{
    const double mu = numberIn(law, "mu", kPositive), lambda = numberIn(law, "lambda", kNotNegative);
    const double damping = law.Attribute("damping") ? numberIn(law, "damping", kNotNegative) : 0;
    const LameModuli moduli = {mu, lambda};
    const double viscosity = result.m_damping * result.m_moduli.m_mu + damping * moduli.m_mu;
    result.m_moduli += moduli;
    result.m_damping = viscosity / result.m_moduli.m_mu;
    result.m_elastic = true;
}

std::string withoutScheme(std::string name)
{
    for (const char* scheme : {"package://", "model://"})
        if (name.rfind(scheme, 0) == 0) return name.substr(std::string(scheme).size());
    return name;
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
    fail(element,
         "the file '" + given + "' is neither beside the URDF file nor in the four folders above; put it there");
}

void findMeshes(const XMLElement& block, const std::filesystem::path& urdf, UrdfDeformable& result)
{
    const XMLElement *visual = block.FirstChildElement("visual"), *collision = block.FirstChildElement("collision");
    if (!visual && !collision) fail(block, "a <visual filename=\"...\"/> that names the mesh is missing");
    if (visual) result.m_visualPath = findMesh(*visual, urdf);
    result.m_meshPath = collision ? findMesh(*collision, urdf) : result.m_visualPath;
    if (result.m_visualPath == result.m_meshPath) result.m_visualPath.clear();
}

const XMLElement& blockOf(const tinyxml2::XMLDocument& document)
{
    const XMLElement* robot = document.FirstChildElement("robot");
    if (!robot) throw std::runtime_error("there is no <robot> element; a URDF file has one around everything");
    const XMLElement* block = robot->FirstChildElement("deformable");
    if (block) return *block;
    if (const XMLElement* reduced = robot->FirstChildElement("reduced_deformable"))
        fail(*reduced, "reduced bodies are not made; write a <deformable> with its moduli and its mesh");
    fail(*robot, "there is no <deformable> in it; rigid links are for Bullet's own importer");
}

UrdfDeformable readBlock(const XMLElement& block, const std::filesystem::path& urdf)
{
    UrdfDeformable result;
    result.m_name = attributeOf(block, "name");
    result.m_mass = massOf(block);
    readValue(block, "collision_margin", kNotNegative, result.m_collisionMargin);
    readValue(block, "friction", kNotNegative, result.m_friction);
    readValue(block, "gravity_factor", kFinite, result.m_gravityFactor);
    for (const char* name : {"corotated", "neohookean"})
        if (const XMLElement* law = block.FirstChildElement(name)) addLaw(*law, result);
    findMeshes(block, urdf, result);
    return result;
}

}  // namespace

UrdfDeformable readUrdfDeformable(const std::string& path)
{
    try
    {
        if (!std::filesystem::is_regular_file(path)) throw std::runtime_error("there is no such file");
        tinyxml2::XMLDocument document;
        if (document.LoadFile(path.c_str()) != tinyxml2::XML_SUCCESS)
            throw std::runtime_error(
                message("line ", document.ErrorLineNum(), ": it is not XML (", document.ErrorName(), ")"));
        return readBlock(blockOf(document), path);
    }
    catch (const std::exception& error)
    {
        throw std::runtime_error("cannot read the URDF file '" + path + "': " + reasonOf(error));
    }
}

}  // namespace bullet_fem

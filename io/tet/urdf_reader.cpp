// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "io/tet/urdf_elements.h"

namespace bullet_fem
{
namespace
{

using tinyxml2::XMLElement;

double massOf(const XMLElement& block)
{
    const XMLElement* inertial = block.FirstChildElement("inertial");
    if (!inertial) failInUrdf(block, "an <inertial> with a <mass> is missing");
    const XMLElement* mass = inertial->FirstChildElement("mass");
    if (!mass) failInUrdf(*inertial, "a <mass> is missing");
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

void findMeshes(const XMLElement& block, const std::filesystem::path& urdf, UrdfDeformable& result)
{
    const XMLElement *visual = block.FirstChildElement("visual"), *collision = block.FirstChildElement("collision");
    if (!visual && !collision) failInUrdf(block, "a <visual filename=\"...\"/> that names the mesh is missing");
    if (visual) result.m_visualPath = findMesh(*visual, urdf);
    result.m_meshPath = collision ? findMesh(*collision, urdf) : result.m_visualPath;
    if (result.m_visualPath == result.m_meshPath) result.m_visualPath.clear();
}

}  // namespace

UrdfDeformable readDeformable(const XMLElement& block, const std::filesystem::path& urdf)
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

UrdfDeformable readUrdfDeformable(const std::string& path)
{
    return readUrdf(
        path,
        [&path](const XMLElement& robot)
        {
            if (const XMLElement* block = robot.FirstChildElement("deformable")) return readDeformable(*block, path);
            if (const XMLElement* reduced = robot.FirstChildElement("reduced_deformable"))
                failInUrdf(*reduced, "reduced bodies are not made; write a <deformable> with its moduli and its mesh");
            failInUrdf(robot, "there is no <deformable> in it; rigid links are for readUrdfRobot");
        });
}

}  // namespace bullet_fem

// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <string>
#include <vector>

#include "bullet_fem/fem/common/export.h"
#include "bullet_fem/fem/laws/elastic_law.h"

namespace bullet_fem
{

/// A constant of a law, an entry of Material::m_lawConstants.
struct LawConstant
{
    const char* m_name;    ///< in scenes and programs
    const char* m_unit;    ///< "Pa", "-"
    double m_default;      ///< where none is given
    double m_low, m_high;  ///< range
    const char* m_remedy;  ///< for a value outside it
};

/// Name of a law in scenes and programs.
BULLETFEM_API const char* nameOf(ElasticLaw law);

/// Constants of a law in the order of Material::m_lawConstants; empty for laws of E and nu.
BULLETFEM_API const std::vector<LawConstant>& constantsOf(ElasticLaw law);

/// True and the law called `name`, if there is one.
BULLETFEM_API bool findLaw(const std::string& name, ElasticLaw& law);

/// Names of all laws, separated by commas.
BULLETFEM_API std::string listOfLaws();

/// True if the law stiffens without bound in compression, so that no weight flattens an element.
BULLETFEM_API bool stiffensInCompression(ElasticLaw law);

}  // namespace bullet_fem

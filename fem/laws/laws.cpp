// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include <algorithm>

#include "fem/common/message.h"
#include "fem/laws/damage.h"
#include "fem/laws/hooke.h"
#include "fem/laws/law.h"
#include "fem/laws/neo_hooke.h"
#include "fem/laws/ogden.h"
#include "fem/laws/orthotropic_law.h"

namespace bullet_fem
{

const std::vector<Law>& allLaws()
{
    static const std::vector<Law> laws = {hookeLaw(), neoHookeLaw(), orthotropicLaw(), ogdenLaw(), damageLaw()};
    return laws;
}

bool areLawConstants(const Law& law, const double* constants, std::string* why)
{
    for (std::size_t k = 0; k < law.m_constants.size(); ++k)
    {
        const LawConstant& constant = law.m_constants[k];
        if (constants[k] >= constant.m_low && constants[k] <= constant.m_high) continue;  // false for NaN
        if (why)
            *why = message(law.m_title, ": ", constant.m_name, " [", constant.m_unit, "] is ", constants[k],
                           ", outside [", constant.m_low, ", ", constant.m_high, "]; ", constant.m_remedy);
        return false;
    }
    return !law.m_isConsistent || law.m_isConsistent(constants, why);
}

const char* nameOf(ElasticLaw law)
{
    return lawOf(law).m_name;
}

const std::vector<LawConstant>& constantsOf(ElasticLaw law)
{
    return lawOf(law).m_constants;
}

bool findLaw(const std::string& name, ElasticLaw& law)
{
    const auto found =
        std::find_if(allLaws().begin(), allLaws().end(), [&](const Law& known) { return known.m_name == name; });
    if (found == allLaws().end()) return false;
    law = static_cast<ElasticLaw>(found - allLaws().begin());
    return true;
}

std::string listOfLaws()
{
    std::string list;
    for (const Law& law : allLaws()) list += (list.empty() ? "" : ", ") + std::string(law.m_name);
    return list;
}

bool stiffensInCompression(ElasticLaw law)
{
    return lawOf(law).m_hasVolumeRatio;
}

}  // namespace bullet_fem

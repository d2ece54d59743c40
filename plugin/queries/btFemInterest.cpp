// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "bullet_fem/btFemInterest.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "BulletSoftBody/btSoftBody.h"
#include "plugin/record/btFemRangeCheck.h"

namespace
{

// A bound of the interest, in [0, most].
bool checkBound(std::string* why, const char* name, double value, double most)
{
    return btFemRangeCheck(
        value >= 0 && value <= most, why, name, value,
        "[0, " + std::to_string(most) +
            "]; m_reducedUntil <= m_reducedFrom <= m_fullFrom <= 1 and m_reducedUntil <= m_fullUntil <= "
            "m_fullFrom are wanted");
}

}  // namespace

bool btFemDetailPolicy::valid(std::string* why) const
{
    return checkBound(why, "m_fullFrom", m_fullFrom, 1) && checkBound(why, "m_fullUntil", m_fullUntil, m_fullFrom) &&
           checkBound(why, "m_reducedFrom", m_reducedFrom, m_fullFrom) &&
           checkBound(why, "m_reducedUntil", m_reducedUntil, std::min(m_reducedFrom, m_fullUntil)) &&
           btFemRangeCheck(m_dwell >= 0 && m_dwell <= 3600, why, "m_dwell", m_dwell, "[0, 3600] s; 0.5 is usual");
}

btFemViewerInterest::btFemViewerInterest(btScalar nearDistance, btScalar farDistance)
    : m_near(nearDistance), m_far(farDistance)
{
    std::string why;
    if (!valid(nearDistance, farDistance, &why)) throw std::invalid_argument("btFemViewerInterest: " + why);
}

bool btFemViewerInterest::valid(btScalar nearDistance, btScalar farDistance, std::string* why)
{
    const bool good = nearDistance >= 0 && nearDistance < farDistance && std::isfinite(farDistance);
    if (!good && why)
        *why = "distances " + std::to_string(nearDistance) + " and " + std::to_string(farDistance) +
               " m are not finite with 0 <= near < far; 10 and 100 are usual";
    return good;
}

btScalar btFemViewerInterest::interest(const btSoftBody& body)
{
    if (m_isVisible && !m_isVisible(body)) return 0;
    btVector3 lower, upper;
    body.getAabb(lower, upper);
    btVector3 nearest = m_viewer;
    nearest.setMax(lower);
    nearest.setMin(upper);
    const btScalar distance = (m_viewer - nearest).length();
    return std::clamp((m_far - distance) / (m_far - m_near), btScalar(0), btScalar(1));
}

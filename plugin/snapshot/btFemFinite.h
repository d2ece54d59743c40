// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <cmath>

#include "LinearMath/btTransform.h"

/// Whether all numbers of Bullet's values are finite.
struct btFemFinite
{
    static bool is(btScalar value) { return std::isfinite(value); }
    static bool is(const btVector3& v) { return std::isfinite(v[0]) && std::isfinite(v[1]) && std::isfinite(v[2]); }
    static bool is(const btTransform& t)
    {
        return are(t.getBasis()[0], t.getBasis()[1], t.getBasis()[2], t.getOrigin());
    }
    template <class Range>
    static bool is(const Range& values)
    {
        for (const auto& value : values)
            if (!is(value)) return false;
        return true;
    }
    template <class... Values>
    static bool are(const Values&... values)
    {
        return (is(values) && ...);
    }
};

// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <random>

#include "bullet_fem/fem/common/vec3.h"

namespace bullet_fem
{

/// Numbers and vectors in [-1, 1] from a fixed seed.
class Random
{
public:
    Vec3 point() { return {m_uniform(m_engine), m_uniform(m_engine), m_uniform(m_engine)}; }
    double number() { return m_uniform(m_engine); }

private:
    std::mt19937 m_engine{5};
    std::uniform_real_distribution<double> m_uniform{-1, 1};
};

}  // namespace bullet_fem

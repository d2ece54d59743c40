// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "fem/factor/ordering_libraries.h"

namespace bullet_fem
{

std::string amdVersion()
{
    return {};
}

std::string metisVersion()
{
    return {};
}

std::vector<int> amdOrder(const SparsePattern&)
{
    return {};
}

std::vector<int> metisOrder(const SparsePattern&)
{
    return {};
}

}  // namespace bullet_fem

// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "fem/factor/nested_dissection.h"

namespace bullet_fem
{

const char* nestedDissectionLibrary()
{
    return nullptr;
}

std::vector<int> nestedDissectionOrder(const SparsePattern&)
{
    return {};
}

}  // namespace bullet_fem

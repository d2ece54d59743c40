// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// Uses a function whose name is the same in both precisions, while the size of what it returns is not: without a guard
// it links with either library.
#include <bullet_fem/btFemMaterial.h>

int main()
{
    return btFemMaterial::rubber().valid() ? 0 : 1;
}

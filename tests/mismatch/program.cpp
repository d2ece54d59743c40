// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// Uses a function with a common name in both precisions, and results of different size: without a guard it links with
// either library.
#include <bullet_fem/btFemMaterial.h>

int main()
{
    return btFemMaterial::rubber().valid() ? 0 : 1;
}

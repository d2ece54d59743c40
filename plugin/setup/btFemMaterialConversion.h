// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include "bullet_fem/btFemMaterial.h"
#include "bullet_fem/fem/mesh/material.h"

/// Converts the material to that of the core, without validation.
bullet_fem::Material coreMaterial(const btFemMaterial& material);

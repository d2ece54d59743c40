// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include "bullet_fem/btFemMaterial.h"
#include "bullet_fem/fem/mesh/material.h"

/// The material as the core takes it; unchecked.
bullet_fem::Material coreMaterial(const btFemMaterial& material);

// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "bullet_fem/btFemPrecision.h"

const char BULLETFEM_PRECISION_TAG = 0;
const char BULLETFEM_VERSION_TAG = 0;

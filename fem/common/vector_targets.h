// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

/// The instruction sets of Highway that are disabled for kernels: every file with kernels includes this before Highway,
/// and every test that counts their targets. SSSE3 and the later levels of AVX-512 add compile time without speed here.
/// Vectors of Arm's SVE and of RISC-V have no compile-time size, so no array or struct can hold them; such processors
/// run NEON, or plain C++.
#define BULLETFEM_DISABLED_TARGETS (HWY_SSSE3 | HWY_AVX3_DL | HWY_SVE | HWY_SVE2 | HWY_SVE_256 | HWY_SVE2_128 | HWY_RVV)
#define HWY_DISABLED_TARGETS BULLETFEM_DISABLED_TARGETS

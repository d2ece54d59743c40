// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

/// The instruction sets of Highway that are disabled for kernels: every file with kernels includes this before Highway,
/// and every test that counts their targets. SSSE3 and the later levels of AVX-512 add compile time without speed here.
/// Vectors of Arm's SVE and of RISC-V have no compile-time size, so no array or struct can hold them; such processors
/// run NEON, or plain C++. A build may leave out more, to compile sooner.
#ifndef BULLETFEM_LEFT_OUT_TARGETS
#define BULLETFEM_LEFT_OUT_TARGETS 0
#endif
#define BULLETFEM_DISABLED_TARGETS \
    (HWY_SSSE3 | HWY_AVX3_DL | HWY_SVE | HWY_SVE2 | HWY_SVE_256 | HWY_SVE2_128 | HWY_RVV | (BULLETFEM_LEFT_OUT_TARGETS))
#define HWY_DISABLED_TARGETS BULLETFEM_DISABLED_TARGETS

/// In HWY_NAMESPACE: names the instances of a kernel template, called with a Work and a Range, for Highway's export.
#define BULLETFEM_KERNEL(kernel, Work)                         \
    void kernel##Float(const Work<float>& work, Range range)   \
    {                                                          \
        kernel(work, range);                                   \
    }                                                          \
    void kernel##Double(const Work<double>& work, Range range) \
    {                                                          \
        kernel(work, range);                                   \
    }

/// Outside HWY_NAMESPACE: defines a function as the kernel for the processor's widest vectors; the last arguments are
/// those of the call.
#define BULLETFEM_EXPORT(kernel, declaration, ...)        \
    HWY_EXPORT(kernel);                                   \
    declaration                                           \
    {                                                     \
        return HWY_DYNAMIC_DISPATCH(kernel)(__VA_ARGS__); \
    }

/// Outside HWY_NAMESPACE: defines the template `run`, of a Work and a Range, as such a kernel in both precisions.
#define BULLETFEM_EXPORT_KERNEL(kernel, Work, run)                                                           \
    BULLETFEM_EXPORT(kernel##Float, template <> void run(const Work<float>& work, Range range), work, range) \
    BULLETFEM_EXPORT(kernel##Double, template <> void run(const Work<double>& work, Range range), work, range)

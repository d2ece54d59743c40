// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include "LinearMath/btScalar.h"
#include "bullet_fem/fem/common/export.h"

// Bullet's headers serve both of its precisions, and most of their names are the same in both: a program that mixes
// them may link, and writes beyond the ends of Bullet's objects. Every public header includes this one, which stops
// that.

// When compiling: the target that is linked has told its precision, and what else is linked beside it.
#if defined(BULLETFEM_PRECISION_float) && defined(BULLETFEM_PRECISION_float64)
#error "BulletFEM::plugin and BulletFEM::plugin-float64 are both linked: choose the one that has Bullet's precision"
#elif defined(BULLETFEM_PRECISION_float) && defined(BT_USE_DOUBLE_PRECISION)
#error "BulletFEM::plugin is single precision, but BT_USE_DOUBLE_PRECISION is defined: link BulletFEM::plugin-float64"
#elif defined(BULLETFEM_PRECISION_float64) && !defined(BT_USE_DOUBLE_PRECISION)
#error \
    "BulletFEM::plugin-float64 is double precision, but BT_USE_DOUBLE_PRECISION is not defined: link BulletFEM::plugin"
#elif defined(BULLETFEM_LINKS_BULLET_OF_OTHER_PRECISION) && defined(BULLETFEM_PRECISION_float)
#error \
    "BulletFEM::plugin is single precision, but Bullet's -float64 libraries are linked: link BulletFEM::plugin-float64"
#elif defined(BULLETFEM_LINKS_BULLET_OF_OTHER_PRECISION)
#error "BulletFEM::plugin-float64 is double precision, but Bullet's float libraries are linked: leave them out"
#endif

// When linking: whoever includes a public header needs a symbol that only the library of the same precision has. Its
// name is what the linker says. `used` keeps the reference though nothing reads it; the two have different names, so
// that the linker cannot take one for the other.
#if defined(BT_USE_DOUBLE_PRECISION)
#define BULLETFEM_PRECISION_TAG bulletfem_error__the_program_is_double_precision__link_plugin_float64_not_plugin
#define BULLETFEM_PRECISION_REFERENCE btFemNeedsDoublePrecision
#else
#define BULLETFEM_PRECISION_TAG bulletfem_error__the_program_is_single_precision__link_plugin_not_plugin_float64
#define BULLETFEM_PRECISION_REFERENCE btFemNeedsSinglePrecision
#endif

// The same for Bullet's version, as its headers have it: layouts differ between versions as well.
#define BULLETFEM_JOIN(a, b, c) a##b##c
#define BULLETFEM_JOINED(a, b, c) BULLETFEM_JOIN(a, b, c)
#define BULLETFEM_VERSION_TAG \
    BULLETFEM_JOINED(bulletfem_error__the_program_has_headers_of_Bullet_, BT_BULLET_VERSION, __the_library_others)
#define BULLETFEM_VERSION_REFERENCE BULLETFEM_JOINED(btFemNeedsBullet, BT_BULLET_VERSION, )

/// Defined by the library; their values mean nothing.
extern "C" BULLETFEM_API const char BULLETFEM_PRECISION_TAG;
extern "C" BULLETFEM_API const char BULLETFEM_VERSION_TAG;

/// Makes every object file that includes a public header refer to the tag; `retain` also where the linker drops what
/// nothing refers to (--gc-sections).
#if __has_cpp_attribute(gnu::retain) && !defined(_WIN32)
#define BULLETFEM_RETAIN [[gnu::used, gnu::retain]]
#else
#define BULLETFEM_RETAIN [[gnu::used]]
#endif
BULLETFEM_RETAIN inline const char* const BULLETFEM_PRECISION_REFERENCE = &BULLETFEM_PRECISION_TAG;
BULLETFEM_RETAIN inline const char* const BULLETFEM_VERSION_REFERENCE = &BULLETFEM_VERSION_TAG;

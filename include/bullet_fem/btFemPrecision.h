// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include "LinearMath/btScalar.h"
#include "bullet_fem/fem/common/export.h"

// Bullet's headers serve both of its precisions, and most symbol names do not depend on the precision: a program that
// mixes the two may link, and then writes beyond the ends of Bullet's objects. Every public header includes this one,
// which prevents that.

// Compile-time check: the linked target defines its precision and that of other linked targets.
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

// Link-time check: including a public header references a symbol that only the library of that precision defines. The
// symbol's name is the linker's error message. `used` keeps the unread reference; the references have different names
// per precision, so that the linker cannot merge them.
#if defined(BT_USE_DOUBLE_PRECISION)
#define BULLETFEM_PRECISION_TAG bulletfem_error__the_program_is_double_precision__link_plugin_float64_not_plugin
#define BULLETFEM_PRECISION_REFERENCE btFemNeedsDoublePrecision
#else
#define BULLETFEM_PRECISION_TAG bulletfem_error__the_program_is_single_precision__link_plugin_not_plugin_float64
#define BULLETFEM_PRECISION_REFERENCE btFemNeedsSinglePrecision
#endif

// Link-time check of Bullet's version, because layouts differ between versions, too.
#define BULLETFEM_JOIN(a, b, c) a##b##c
#define BULLETFEM_JOINED(a, b, c) BULLETFEM_JOIN(a, b, c)
#define BULLETFEM_VERSION_TAG \
    BULLETFEM_JOINED(bulletfem_error__the_program_has_headers_of_Bullet_, BT_BULLET_VERSION, __the_library_others)
#define BULLETFEM_VERSION_REFERENCE BULLETFEM_JOINED(btFemNeedsBullet, BT_BULLET_VERSION, )

/// Defined by the library; the values have no meaning.
extern "C" BULLETFEM_API const char BULLETFEM_PRECISION_TAG;
extern "C" BULLETFEM_API const char BULLETFEM_VERSION_TAG;

/// Makes every object file that includes a public header refer to the tag; `retain` keeps the reference where the
/// linker drops unreferenced data (--gc-sections).
#if __has_cpp_attribute(gnu::retain) && !defined(_WIN32)
#define BULLETFEM_RETAIN [[gnu::used, gnu::retain]]
#else
#define BULLETFEM_RETAIN [[gnu::used]]
#endif
BULLETFEM_RETAIN inline const char* const BULLETFEM_PRECISION_REFERENCE = &BULLETFEM_PRECISION_TAG;
BULLETFEM_RETAIN inline const char* const BULLETFEM_VERSION_REFERENCE = &BULLETFEM_VERSION_TAG;

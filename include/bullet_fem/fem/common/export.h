// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

/// Marks the symbols that shared libraries export (BUILD_SHARED_LIBS): the public names, and the few internal ones that
/// one library calls in another. All other symbols are hidden. The macro is empty for static libraries and on Windows,
/// where only static libraries are built.
#if defined(__GNUC__) && !defined(_WIN32)
#define BULLETFEM_API __attribute__((visibility("default")))
#else
#define BULLETFEM_API
#endif

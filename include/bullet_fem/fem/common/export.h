// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

/// Marks what shared libraries export (BUILD_SHARED_LIBS): the public names, and the few others that one library calls
/// in another. All else is hidden in them. It changes nothing in static libraries, and Windows has only these.
#if defined(__GNUC__) && !defined(_WIN32)
#define BULLETFEM_API __attribute__((visibility("default")))
#else
#define BULLETFEM_API
#endif

// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <algorithm>

#if defined(__SANITIZE_THREAD__)
#define BULLETFEM_UNDER_THREAD_SANITIZER true
#elif defined(__has_feature)
#if __has_feature(thread_sanitizer)
#define BULLETFEM_UNDER_THREAD_SANITIZER true
#endif
#endif
#ifndef BULLETFEM_UNDER_THREAD_SANITIZER
#define BULLETFEM_UNDER_THREAD_SANITIZER false
#endif

namespace bullet_fem
{

/// How many steps a test of threads takes that takes so many usually. Under ThreadSanitizer a step takes tens of times
/// as long, and what threads do is alike in all of them.
constexpr int stepsOnThreads(int usually)
{
    constexpr int kMaxUnderThreadSanitizer = 12;
    return BULLETFEM_UNDER_THREAD_SANITIZER ? std::min(usually, kMaxUnderThreadSanitizer) : usually;
}

}  // namespace bullet_fem

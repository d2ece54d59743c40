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

/// The number of steps for a threaded test that usually makes `usually`. Under ThreadSanitizer a step takes tens of
/// times as long, and threads do equal work in all steps.
constexpr int stepsOnThreads(int usually)
{
    constexpr int kMaxUnderThreadSanitizer = 12;
    return BULLETFEM_UNDER_THREAD_SANITIZER ? std::min(usually, kMaxUnderThreadSanitizer) : usually;
}

}  // namespace bullet_fem

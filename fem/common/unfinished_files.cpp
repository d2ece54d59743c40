// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "fem/common/unfinished_files.h"

#include <atomic>
#include <cstdio>
#include <cstring>

#if defined(__unix__) || defined(__APPLE__)
#include <unistd.h>
#endif

namespace bullet_fem
{
namespace
{

constexpr std::size_t kLongestPath = 1000;  // bytes

enum PlaceState
{
    isFree,
    isBeingWritten,
    isUnfinished
};

// A signal handler must not allocate memory, nor wait for a lock that the interrupted thread may hold.
struct Place
{
    std::atomic<int> m_state{isFree};
    char m_path[kLongestPath + 1];
};

Place unfinished[64];

}  // namespace

int noteUnfinishedFile(const std::string& path)
{
    if (path.size() > kLongestPath) return -1;
    int k = 0;
    for (Place& place : unfinished)
    {
        int state = isFree;
        if (place.m_state.compare_exchange_strong(state, isBeingWritten))
        {
            std::memcpy(place.m_path, path.c_str(), path.size() + 1);
            place.m_state = isUnfinished;
            return k;
        }
        ++k;
    }
    return -1;
}

void forgetUnfinishedFile(int place)
{
    if (place >= 0) unfinished[place].m_state = isFree;
}

void removeUnfinishedFiles()
{
    for (const Place& place : unfinished)
    {
        if (place.m_state != isUnfinished) continue;
#if defined(__unix__) || defined(__APPLE__)
        unlink(place.m_path);
#else
        std::remove(place.m_path);
#endif
    }
}

}  // namespace bullet_fem

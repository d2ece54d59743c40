// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <signal.h>
#include <sys/resource.h>

#include <stdexcept>

namespace bullet_fem
{

/// During its lifetime no file of this process grows beyond a number of bytes: as on a full disk, the first part can be
/// written.
class FullDisk
{
public:
    explicit FullDisk(rlim_t bytes) : m_handler(signal(SIGXFSZ, SIG_IGN))
    {
        const bool known = getrlimit(RLIMIT_FSIZE, &m_before) == 0;
        const rlimit small = {bytes, m_before.rlim_max};
        if (!known || setrlimit(RLIMIT_FSIZE, &small) != 0) throw std::runtime_error("cannot limit the size of files");
    }
    ~FullDisk()
    {
        setrlimit(RLIMIT_FSIZE, &m_before);
        signal(SIGXFSZ, m_handler);
    }
    FullDisk(const FullDisk&) = delete;
    FullDisk& operator=(const FullDisk&) = delete;

private:
    rlimit m_before = {};
    void (*m_handler)(int);
};

}  // namespace bullet_fem

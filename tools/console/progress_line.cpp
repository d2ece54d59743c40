// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "tools/console/progress_line.h"

#ifdef _WIN32
#include <io.h>
#else
#include <unistd.h>
#endif

#include <algorithm>
#include <cstdio>

namespace bullet_fem
{
namespace
{

bool isTerminal(std::FILE* file)
{
#ifdef _WIN32
    return _isatty(_fileno(file)) != 0;
#else
    return isatty(fileno(file)) != 0;
#endif
}

}  // namespace

ProgressLine::ProgressLine() : m_onTerminal(isTerminal(stdout)) {}

void ProgressLine::show(double done, const std::string& text)
{
    const int parts = m_onTerminal ? 100 : 10;
    const int part = static_cast<int>(done * parts + 1e-9);
    if (part == m_shown) return;
    m_shown = part;
    m_width = std::max(m_width, text.size());
    std::printf(m_onTerminal ? "\r%3d %%  %-*s" : "%3d %%  %-*s\n", part * 100 / parts, static_cast<int>(m_width),
                text.c_str());
    std::fflush(stdout);
}

void ProgressLine::finish()
{
    if (m_onTerminal && m_shown >= 0) std::printf("\n");
}

}  // namespace bullet_fem

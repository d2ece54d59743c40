// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "tools/console/program.h"

#include <csignal>
#include <cstdio>
#include <exception>

#include "fem/common/reason.h"
#include "fem/common/unfinished_files.h"
#include "tools/console/option_range.h"

namespace bullet_fem
{
namespace
{

extern "C" void endByStopSignal(int number)
{
    removeUnfinishedFiles();
    std::signal(number, SIG_DFL);
    std::raise(number);
}

// Signals that were ignored at program start, as under nohup, stay ignored.
void endCleanlyBy(int number)
{
    if (std::signal(number, endByStopSignal) == SIG_IGN) std::signal(number, SIG_IGN);
}

}  // namespace

int runProgram(const char* name, const std::function<int()>& run)
{
#ifdef SIGXFSZ
    std::signal(SIGXFSZ, SIG_IGN);
#endif
#ifdef SIGHUP
    endCleanlyBy(SIGHUP);
#endif
    endCleanlyBy(SIGINT);
    endCleanlyBy(SIGTERM);
    try
    {
        return run();
    }
    catch (const std::exception& error)
    {
        std::fprintf(stderr, "%s: %s\n", name, reasonOf(error).c_str());
        return kDataError;
    }
}

}  // namespace bullet_fem

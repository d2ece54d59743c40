// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <stdio.h>
#include <sys/wait.h>

#include <stdexcept>
#include <string>

namespace bullet_fem
{

/// The result of a program.
struct ProgramRun
{
    int m_code = -1;       ///< exit code; -1 if it did not exit by itself
    std::string m_output;  ///< standard output and standard error
};

/// Runs a shell command line.
inline ProgramRun runShell(const std::string& line)
{
    FILE* pipe = popen((line + " 2>&1").c_str(), "r");
    if (!pipe) throw std::runtime_error("cannot run " + line);
    ProgramRun run;
    char part[4096];
    for (std::size_t size; (size = fread(part, 1, sizeof part, pipe)) > 0;) run.m_output.append(part, size);
    const int status = pclose(pipe);
    if (WIFEXITED(status)) run.m_code = WEXITSTATUS(status);
    return run;
}

#ifdef BULLETFEM_PROGRAM
/// Runs the program bulletfem with these arguments.
inline ProgramRun bulletfem(const std::string& arguments)
{
    return runShell("'" BULLETFEM_PROGRAM "' " + arguments);
}
#endif

}  // namespace bullet_fem

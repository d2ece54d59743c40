// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "soak/child_run.h"

#include <signal.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <sstream>
#include <stdexcept>

#include "fem/common/message.h"

namespace bullet_fem
{
namespace
{

[[noreturn]] void beChild(const std::function<SoakOutcome()>& run, int seconds, int pipe)
{
    const rlimit most = {static_cast<rlim_t>(seconds), RLIM_INFINITY};
    setrlimit(RLIMIT_CPU, &most);
    const SoakOutcome outcome = run();
    const std::string text = message(outcome.m_steps, " ", outcome.m_refusals, "\n", outcome.m_fault);
    const bool written = write(pipe, text.data(), text.size()) == static_cast<ssize_t>(text.size());
    _exit(written ? 0 : 1);
}

std::string readAll(int pipe)
{
    std::string text;
    char part[4096];
    for (ssize_t size; (size = read(pipe, part, sizeof part)) != 0;)
    {
        if (size > 0) text.append(part, static_cast<std::size_t>(size));
        if (size < 0 && errno != EINTR) break;
    }
    return text;
}

}  // namespace

SoakOutcome runInChild(const std::function<SoakOutcome()>& run, int seconds)
{
    int ends[2];
    std::fflush(nullptr);  // otherwise the child would write it, too
    if (pipe(ends) != 0) throw std::runtime_error("there is no pipe to be had; close other programs");
    const pid_t child = fork();
    if (child < 0) throw std::runtime_error("there is no process to be had; close other programs");
    if (child == 0) beChild(run, seconds, ends[1]);
    close(ends[1]);
    const std::string text = readAll(ends[0]);
    close(ends[0]);
    int status = 0;
    while (waitpid(child, &status, 0) < 0 && errno == EINTR)
    {
    }
    SoakOutcome outcome;
    std::istringstream words(text);
    words >> outcome.m_steps >> outcome.m_refusals;
    words.ignore();
    std::getline(words, outcome.m_fault, '\0');
    if (WIFSIGNALED(status) && WTERMSIG(status) == SIGXCPU)
        outcome.m_fault = message("it took more than ", seconds, " s of a processor");
    else if (WIFSIGNALED(status))
        outcome.m_fault = message("it ended by signal ", WTERMSIG(status));
    else if (WEXITSTATUS(status) != 0)
        outcome.m_fault = message("it ended with exit code ", WEXITSTATUS(status));
    return outcome;
}

}  // namespace bullet_fem

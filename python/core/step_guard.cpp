// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "python/core/step_guard.h"

#include <pthread.h>

#include <atomic>
#include <stdexcept>
#include <utility>

namespace bullet_fem::python
{
namespace
{

std::atomic<int> steps{0};            // under way, of all threads
thread_local int ownSteps = 0;        // of this thread, which may fork in a callback
std::atomic<int> worldsOfThreads{0};  // that have a thread in the background
bool lost = false;

void noteFork()
{
    lost = lost || steps > ownSteps || worldsOfThreads > 0;
}

}  // namespace

StepGuard::StepGuard(bool factorsInBackground) : m_factorsInBackground(factorsInBackground)
{
    static const int registered = pthread_atfork(nullptr, nullptr, &noteFork);
    (void)registered;
    reading();
    if (m_factorsInBackground) ++worldsOfThreads;
}

StepGuard::~StepGuard()
{
    if (m_factorsInBackground) --worldsOfThreads;
}

StepGuard::Step::Step(StepGuard& guard) : m_guard(guard)
{
    guard.changing();
    if (guard.m_isStepping)
        throw std::runtime_error("the world is being stepped, and this function is called by step(): it must not step");
    guard.m_isStepping = true;
    guard.m_stepper = std::this_thread::get_id();
    ++steps;
    ++ownSteps;
}

StepGuard::Step::~Step()
{
    m_guard.m_isStepping = false;
    --steps;
    --ownSteps;
}

bool StepGuard::isLost()
{
    return lost;
}

void StepGuard::reading() const
{
    if (lost)
        throw std::runtime_error(
            "this process was forked from one in which a thread stepped a world or factored in the background, and "
            "such "
            "threads do not survive a fork: start processes by multiprocessing.get_context('spawn')");
    if (m_isStepping && m_stepper != std::this_thread::get_id())
        throw std::runtime_error("the world is being stepped by another thread: wait until its step() returns");
}

void StepGuard::changing() const
{
    reading();
    if (m_isStepping && !m_isPaused)
        throw std::runtime_error(
            "the world is being stepped, and this is a callback of that step: change or step the world after it");
}

void StepGuard::keepException()
{
    if (!m_thrown) m_thrown = std::current_exception();
}

void StepGuard::rethrow()
{
    if (m_thrown) std::rethrow_exception(std::exchange(m_thrown, nullptr));
}

}  // namespace bullet_fem::python

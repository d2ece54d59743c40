// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <exception>
#include <thread>

namespace bullet_fem::python
{

/// Knows whether a world is being stepped and by whom, and refuses calls that a step does not bear. All functions are
/// to be called with Python's lock (GIL).
class StepGuard
{
public:
    /// Steps of the world, while it lives. Throws as changing() does, and within steps.
    class Step
    {
    public:
        explicit Step(StepGuard& guard);
        ~Step();
        Step(const Step&) = delete;
        Step& operator=(const Step&) = delete;

    private:
        StepGuard& m_guard;
    };

    /// The time between two steps of a Step, in which a function of the program may change the world.
    class Pause
    {
    public:
        explicit Pause(StepGuard& guard) : m_guard(guard) { m_guard.m_isPaused = true; }
        ~Pause() { m_guard.m_isPaused = false; }
        Pause(const Pause&) = delete;
        Pause& operator=(const Pause&) = delete;

    private:
        StepGuard& m_guard;
    };

    /// `factorsInBackground`: the world has a thread. Throws as reading() does, if the process is lost.
    explicit StepGuard(bool factorsInBackground);
    ~StepGuard();
    StepGuard(const StepGuard&) = delete;
    StepGuard& operator=(const StepGuard&) = delete;

    /// Throws std::runtime_error if another thread steps the world, or if the process is lost.
    void reading() const;
    /// Throws as reading() does, and within a callback of a step.
    void changing() const;
    /// Whether the process was forked while a thread stepped a world or could factor in the background. Such threads do
    /// not exist in it, but their locks may be held for ever.
    static bool isLost();

    /// Keeps the present exception until the step is over; the first one if there are several.
    void keepException();
    void rethrow();

private:
    const bool m_factorsInBackground;
    bool m_isStepping = false, m_isPaused = false;
    std::thread::id m_stepper;
    std::exception_ptr m_thrown;
};

}  // namespace bullet_fem::python

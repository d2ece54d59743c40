// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <memory>

#include "bullet_fem/fem/common/export.h"

namespace bullet_fem
{

/// A half-open index range [m_begin, m_end).
struct Range
{
    int m_begin;  ///< first index
    int m_end;    ///< one past the last index
};

/// A team of threads that shares the work of steps. Results have identical bits for every thread count, because work is
/// divided by its own size, never by the number of threads. Several threads may use one object at once, also from
/// within its own tasks. A count of 1 starts no thread besides the caller's and allocates nothing; with more, oneTBB
/// allocates small tasks from pools of its own. The object must outlive its use.
class BULLETFEM_API Threads
{
public:
    static constexpr int kMax = 256;  ///< maximum number of threads
    [[deprecated("kMax")]] static constexpr int kMost = kMax;

    /// Creates a team of `count` threads, the caller's included, in [0, 256]; 0: as many as the machine grants this
    /// process. A larger count than that is allowed, but slow. Always one thread if the library was built without
    /// oneTBB. Throws std::invalid_argument if `count` is out of range.
    explicit Threads(int count = 1);
    ~Threads();
    Threads(const Threads&) = delete;
    Threads& operator=(const Threads&) = delete;

    /// Number of threads, >= 1.
    int count() const { return m_count; }

    /// Calls task(k) once for every k in [0, tasks), on any thread, with the caller's floating-point settings, and
    /// returns when all calls are done. If tasks throw, the remaining ones still run; then the exception of the lowest
    /// k is thrown.
    template <class Task>
    void run(int tasks, const Task& task) const
    {
        runCalls(tasks, {[](const void* held, int k) { (*static_cast<const Task*>(held))(k); }, &task});
    }

    /// Calls task() inside the team, so that many short run() calls within it need not enter the team one by one.
    template <class Task>
    void gather(const Task& task) const
    {
        gatherFor({[](const void* held, int) { (*static_cast<const Task*>(held))(); }, &task});
    }

private:
    struct Call
    {
        void (*m_function)(const void* task, int k);
        const void* m_task;
    };
    class Team;

    void runCalls(int tasks, const Call& call) const;
    void gatherFor(const Call& call) const;

    int m_count;
    std::unique_ptr<Team> m_team;  // null for a count of 1
};

}  // namespace bullet_fem

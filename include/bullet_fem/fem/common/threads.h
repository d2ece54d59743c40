// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <memory>

#include "bullet_fem/fem/common/export.h"

namespace bullet_fem
{

/// Things that are worked on together, from m_begin up to, not including, m_end.
struct Range
{
    int m_begin;  ///< the first
    int m_end;    ///< behind the last
};

/// The threads that share the work of steps. Results have the same bits for every count: work is divided by its own
/// size, never by the number of threads. May be used by several threads at once, and from within its own tasks. With a
/// count of 1 there is no thread besides the caller's, and nothing is ever allocated; with more the thread library
/// (oneTBB) allocates small tasks, from pools of its own. Not to be deleted while in use.
class BULLETFEM_API Threads
{
public:
    static constexpr int kMost = 256;  ///< threads at most

    /// `count` threads, the caller's included, in [0, 256]; 0: as many as the machine has for this process. More than
    /// that is granted, and slow. Always one where the library was built without oneTBB. Throws std::invalid_argument.
    explicit Threads(int count = 1);
    ~Threads();
    Threads(const Threads&) = delete;
    Threads& operator=(const Threads&) = delete;

    /// The threads at work at most, >= 1.
    int count() const { return m_count; }

    /// Calls task(k) for every k in [0, tasks), each once, on any thread, with the caller's floating-point settings;
    /// returns when all are done. If tasks throw, the others run nevertheless, and what the first of them (by k) threw
    /// is thrown then.
    template <class Task>
    void run(int tasks, const Task& task) const
    {
        runCalls(tasks, {[](const void* held, int k) { (*static_cast<const Task*>(held))(k); }, &task});
    }

    /// Calls task() among the others: the many short parts that it runs need not enter the team one by one.
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
    std::unique_ptr<Team> m_team;  // null for one thread
};

}  // namespace bullet_fem

// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// The only file that uses oneTBB. Without BULLETFEM_WITH_TBB the calling thread does all work, whatever the count.
// ThreadSanitizer cannot follow oneTBB's internal synchronization: under it threads are created and joined for every
// run.
#include "bullet_fem/fem/common/threads.h"

#if defined(__SANITIZE_THREAD__)
#define BULLETFEM_JOINED_THREADS
#elif defined(__has_feature)
#if __has_feature(thread_sanitizer)
#define BULLETFEM_JOINED_THREADS
#endif
#endif

#ifdef BULLETFEM_JOINED_THREADS
#include <atomic>
#include <thread>
#include <vector>
#endif
#ifdef BULLETFEM_WITH_TBB
#include <oneapi/tbb/global_control.h>
#include <oneapi/tbb/info.h>
#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/task_arena.h>
#include <oneapi/tbb/task_group.h>
#endif

#include <algorithm>
#include <exception>
#include <mutex>

#include "fem/common/message.h"

namespace bullet_fem
{
namespace
{

int validCount(int count)
{
    if (count < 0 || count > Threads::kMax)
        reject("number of threads ", count, " is not in [0, ", Threads::kMax,
               "]; 1 is the caller's thread alone, 0 all that the machine has");
#ifdef BULLETFEM_WITH_TBB
    return count == 0 ? std::clamp(tbb::info::default_concurrency(), 1, Threads::kMax) : count;
#else
    return 1;
#endif
}

/// The exception of the lowest-numbered task that threw.
class FirstFailure
{
public:
    void note(int task)
    {
        const std::lock_guard<std::mutex> lock(m_mutex);
        if (m_thrown && m_task < task) return;
        m_task = task;
        m_thrown = std::current_exception();
    }
    void rethrow() const
    {
        if (m_thrown) std::rethrow_exception(m_thrown);
    }

private:
    std::mutex m_mutex;
    int m_task = 0;
    std::exception_ptr m_thrown;
};

}  // namespace

#ifdef BULLETFEM_JOINED_THREADS
class Threads::Team
{
public:
    explicit Team(int count) : m_count(count) {}
    template <class Part>
    void execute(const Part& part)
    {
        part();
    }
    template <class Task>
    void run(int tasks, const Task& task)
    {
        std::atomic<int> next{0};
        const auto work = [&]
        {
            for (int k = next++; k < tasks; k = next++) task(k);
        };
        std::vector<std::thread> others;
        for (int k = 1; k < std::min(m_count, tasks); ++k) others.emplace_back(work);
        work();
        for (std::thread& other : others) other.join();
    }

private:
    int m_count;
};
#elif defined(BULLETFEM_WITH_TBB)
/// A share of oneTBB's worker threads.
class Threads::Team
{
    static constexpr auto kParallelism = tbb::global_control::max_allowed_parallelism;

public:
    // oneTBB creates no more threads than the machine has unless the limit is raised; it never falls below that of
    // others.
    explicit Team(int count)
        : m_limit(kParallelism, std::max<std::size_t>(count, tbb::global_control::active_value(kParallelism))),
          m_arena(count)
    {
    }

    template <class Part>
    void execute(const Part& part)
    {
        m_arena.execute(part);
    }

    template <class Task>
    void run(int tasks, const Task& task)
    {
        // Captures the caller's floating-point settings, because another thread may run the tasks.
        tbb::task_group_context asCaller(tbb::task_group_context::isolated, tbb::task_group_context::fp_settings);
        execute([&] { tbb::parallel_for(0, tasks, task, tbb::auto_partitioner(), asCaller); });
    }

private:
    tbb::global_control m_limit;
    tbb::task_arena m_arena;
};
#else
/// A team without worker threads.
class Threads::Team
{
public:
    explicit Team(int) {}
    template <class Part>
    void execute(const Part& part)
    {
        part();
    }
    template <class Task>
    void run(int tasks, const Task& task)
    {
        for (int k = 0; k < tasks; ++k) task(k);
    }
};
#endif

Threads::Threads(int count) : m_count(validCount(count))
{
    if (m_count > 1) m_team = std::make_unique<Team>(m_count);
}

Threads::~Threads() = default;

void Threads::runCalls(int tasks, const Call& call) const
{
    FirstFailure failure;
    const auto attempt = [&](int k)
    {
        try
        {
            call.m_function(call.m_task, k);
        }
        catch (...)
        {
            failure.note(k);
        }
    };
    if (!m_team || tasks <= 1)
        for (int k = 0; k < tasks; ++k) attempt(k);
    else
        m_team->run(tasks, attempt);
    failure.rethrow();
}

void Threads::gatherFor(const Call& call) const
{
    if (m_team)
        m_team->execute([&] { call.m_function(call.m_task, 0); });
    else
        call.m_function(call.m_task, 0);
}

}  // namespace bullet_fem

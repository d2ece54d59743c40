// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <array>
#include <optional>

#include "bullet_fem/fem/body.h"
#include "fem/factor/panel_group_kernels.h"
#include "fem/step_scratch.h"
#include "fem/warped_system.h"

namespace bullet_fem
{

/// Smaller bodies are solved in less time than it takes to share one out: nodes, of some 5 tets each.
constexpr int kNodesToShare = 1000;

/// The settings with the threads that may work on a body of this model: none if it is too small.
StepSettings sharedSettings(const BodyModel& model, StepSettings settings);

/// Adds to the increment in a body's scratch, the guess of a solve, the rigid motion of free pieces that gives them the
/// momentum prescribed.
void completeIncrement(Body& body);

/// What an increment is solved to.
struct IncrementGoal
{
    double m_floor = 0;     ///< of |b| for the tolerance [kg m/s], >= 0
    bool m_steady = false;  ///< see ConjugateGradientStop
};

/// Solves A dv = b of one body, as its scratch holds b and a guess of dv, and adds dv to the velocities of its free
/// nodes.
class IncrementSolve
{
public:
    IncrementSolve(Body& body, const StepSettings& settings, const IncrementGoal& goal);
    IncrementSolve(const IncrementSolve&) = delete;
    IncrementSolve& operator=(const IncrementSolve&) = delete;

    /// False once the solve is over; before, wanted() is to be made, and then resume() called.
    bool needsPreconditioner() const { return m_solve.needsPreconditioner(); }
    PreconditionedVector wanted() const;
    void resume() { m_solve.resume(); }

    /// To be called once, at the end.
    SolveReport addToVelocity();

    /// b - A dv at the end, until the next solve.
    const std::vector<Vec3>& residual() const { return m_scratch.m_solver.m_r; }

private:
    Body& m_body;
    StepScratch& m_scratch;
    StepSettings m_settings;
    WarpedSystem m_A;
    ConjugateGradients m_solve;
};

/// Solves for many bodies of one model, some at a time: each round applies the preconditioner to all that are at work,
/// in one pass over the factor; whoever has converged makes room for the next. Every body gets the bits that it gets
/// alone.
class IncrementSolves
{
public:
    explicit IncrementSolves(const Threads* threads) : m_threads(threads) {}

    /// For each job, which has an m_body: begin(job, solve) emplaces its solve, and end(job, solve) is called when it
    /// is over.
    template <class Job, class Begin, class End>
    void run(Job* jobs, int count, const Begin& begin, const End& end)
    {
        int next = 0;
        do
            for (Slot& slot : m_slots)
            {
                if (slot.m_solve && !slot.m_solve->needsPreconditioner()) close(slot, jobs, end);
                for (; !slot.m_solve && next < count; ++next)
                {
                    slot.m_job = next;
                    lend(slot, *jobs[next].m_body);
                    begin(jobs[next], slot.m_solve);
                    if (!slot.m_solve->needsPreconditioner()) close(slot, jobs, end);
                }
            }
        while (advance());
    }

private:
    struct Slot
    {
        int m_job = 0;
        std::optional<IncrementSolve> m_solve;
        Body* m_first = nullptr;  // that was solved here: the later ones use its vectors, which are in the caches
    };

    template <class Job, class End>
    static void close(Slot& slot, Job* jobs, const End& end)
    {
        end(jobs[slot.m_job], *slot.m_solve);
        slot.m_solve.reset();
        lend(slot, *jobs[slot.m_job].m_body);
    }

    static void lend(Slot& slot, Body& body);
    bool advance();

    const Threads* m_threads;
    std::array<Slot, kPanelGroup> m_slots;
};

}  // namespace bullet_fem

// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <atomic>
#include <condition_variable>
#include <deque>
#include <memory>
#include <mutex>
#include <string>
#include <thread>

#include "bullet_fem/fem/factor/body_model.h"

/// A factorization job. m_model and m_error may be read once m_done is true.
struct btFemFactorJob
{
    std::shared_ptr<const bullet_fem::RestShape> m_shape;
    bullet_fem::FactorInput m_input;

    std::atomic<bool> m_done{false};
    std::shared_ptr<const bullet_fem::BodyModel> m_model;  ///< null if the job failed
    std::string m_error;                                   ///< reason of failure
};

/// Factorizes models one after another in a background thread, which starts with the first job. Skips jobs that nobody
/// holds any more. Must be used by one thread.
class btFemFactorThread
{
public:
    btFemFactorThread() = default;
    /// Waits for the running job, and drops the others.
    ~btFemFactorThread();
    btFemFactorThread(const btFemFactorThread&) = delete;
    btFemFactorThread& operator=(const btFemFactorThread&) = delete;

    /// Starts a job; equal requests share one. Throws std::system_error if no thread is available.
    std::shared_ptr<btFemFactorJob> start(const std::shared_ptr<const bullet_fem::RestShape>& shape,
                                          const bullet_fem::FactorInput& input);

private:
    void run();
    std::shared_ptr<btFemFactorJob> next();

    std::mutex m_mutex;  // guards the next three members
    std::condition_variable m_wake;
    std::deque<std::weak_ptr<btFemFactorJob>> m_waiting;
    bool m_ends = false;

    std::deque<std::weak_ptr<btFemFactorJob>> m_started;  // used by the caller only; waiting, running or done
    std::thread m_thread;
};

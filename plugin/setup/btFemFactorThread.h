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

/// A model that is being made; its product may be read once it is done.
struct btFemFactorJob
{
    std::shared_ptr<const bullet_fem::RestShape> m_shape;
    bullet_fem::FactorInput m_input;

    std::atomic<bool> m_done{false};
    std::shared_ptr<const bullet_fem::BodyModel> m_model;  ///< null if it failed
    std::string m_error;                                   ///< why
};

/// Makes models one after another in a thread of its own, which begins with the first job. A job that nobody holds any
/// more is left out. To be called by one thread.
class btFemFactorThread
{
public:
    btFemFactorThread() = default;
    /// Waits for the job that runs, and leaves out the others.
    ~btFemFactorThread();
    btFemFactorThread(const btFemFactorThread&) = delete;
    btFemFactorThread& operator=(const btFemFactorThread&) = delete;

    /// Asks for a model; gives the same job to all who ask for the same. Throws std::system_error if there is no thread
    /// to be had.
    std::shared_ptr<btFemFactorJob> start(const std::shared_ptr<const bullet_fem::RestShape>& shape,
                                          const bullet_fem::FactorInput& input);

private:
    void run();
    std::shared_ptr<btFemFactorJob> next();

    std::mutex m_mutex;  // guards what follows
    std::condition_variable m_wake;
    std::deque<std::weak_ptr<btFemFactorJob>> m_waiting;
    bool m_ends = false;

    std::deque<std::weak_ptr<btFemFactorJob>> m_started;  // of the caller; waiting, running or done
    std::thread m_thread;
};

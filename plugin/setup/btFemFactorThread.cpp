// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "plugin/setup/btFemFactorThread.h"

#include <algorithm>
#include <exception>

#include "fem/common/reason.h"

using namespace bullet_fem;

namespace
{

void make(btFemFactorJob& job)
{
    try
    {
        job.m_model = BodyModel::create(job.m_shape, job.m_input);
    }
    catch (const std::exception& error)
    {
        job.m_error = reasonOf(error);
    }
    job.m_done.store(true, std::memory_order_release);
}

}  // namespace

btFemFactorThread::~btFemFactorThread()
{
    if (!m_thread.joinable()) return;
    {
        const std::lock_guard<std::mutex> lock(m_mutex);
        m_ends = true;
    }
    m_wake.notify_one();
    m_thread.join();
}

std::shared_ptr<btFemFactorJob> btFemFactorThread::start(const std::shared_ptr<const RestShape>& shape,
                                                         const FactorInput& input)
{
    const auto expired = [](const auto& job) { return job.expired(); };
    m_started.erase(std::remove_if(m_started.begin(), m_started.end(), expired), m_started.end());
    for (const auto& started : m_started)
        if (auto job = started.lock())
            if (job->m_shape == shape && job->m_input == input) return job;

    if (!m_thread.joinable()) m_thread = std::thread([this] { run(); });
    auto job = std::make_shared<btFemFactorJob>();
    job->m_shape = shape;
    job->m_input = input;
    m_started.push_back(job);
    {
        const std::lock_guard<std::mutex> lock(m_mutex);
        m_waiting.push_back(job);
    }
    m_wake.notify_one();
    return job;
}

// Waits for the next job that is still held; null when the thread must end.
std::shared_ptr<btFemFactorJob> btFemFactorThread::next()
{
    std::unique_lock<std::mutex> lock(m_mutex);
    for (;;)
    {
        m_wake.wait(lock, [this] { return m_ends || !m_waiting.empty(); });
        if (m_ends) return nullptr;
        auto job = m_waiting.front().lock();
        m_waiting.pop_front();
        if (job) return job;
    }
}

void btFemFactorThread::run()
{
    while (const auto job = next()) make(*job);
}

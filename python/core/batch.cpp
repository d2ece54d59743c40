// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "python/core/batch.h"

#include <algorithm>
#include <atomic>
#include <exception>
#include <stdexcept>
#include <string>
#include <thread>
#include <utility>

#include "python/core/world_state.h"

namespace bullet_fem::python
{
namespace
{

int threadsOf(int asked, std::size_t worlds)
{
    const int all = asked > 0 ? asked : int(std::max(1u, std::thread::hardware_concurrency()));
    return std::max(1, std::min(all, int(worlds)));
}

void mustBeAlike(const World& a, const World& b)
{
    bool alike = a.bodies().size() == b.bodies().size();
    for (int k = 0; alike && k < a.bodies().size(); ++k)
    {
        const BodyEntry &x = a.bodies()[k], &y = b.bodies()[k];
        alike = !x.m_soft == !y.m_soft && !x.m_rigid == !y.m_rigid &&
                (!x.m_soft || x.m_soft->m_body->m_nodes.size() == y.m_soft->m_body->m_nodes.size());
    }
    if (!alike) throw std::invalid_argument("the worlds differ in their bodies: a Batch has worlds of one builder");
}

void append(const btVector3& v, double*& at)
{
    *at++ = v[0];
    *at++ = v[1];
    *at++ = v[2];
}

}  // namespace

Batch::Batch(std::vector<std::shared_ptr<World>> worlds, int threads)
    : m_worlds(std::move(worlds)), m_threads(threadsOf(threads, m_worlds.size()))
{
    if (m_worlds.empty()) throw std::invalid_argument("worlds is empty: a Batch has one or more");
    for (std::size_t k = 0; k < m_worlds.size(); ++k)
    {
        if (std::count(m_worlds.begin(), m_worlds.end(), m_worlds[k]) > 1)
            throw std::invalid_argument("a world comes twice: the builder must make a new one in each call");
        mustBeAlike(*m_worlds[0], *m_worlds[k]);
    }
}

int Batch::nodeCount(int body) const
{
    const BodyTable& bodies = m_worlds[0]->bodies();
    if (body < 0 || body >= bodies.size()) throw std::out_of_range("there is no body of index " + std::to_string(body));
    return bodies[body].m_soft ? bodies[body].m_soft->m_body->m_nodes.size() : 1;
}

// Worlds are taken in order by whichever thread is free: some have more contacts than others.
void Batch::eachWorld(const std::function<void(int)>& call)
{
    std::atomic<int> next{0};
    std::exception_ptr thrown;
    std::atomic<bool> failed{false};
    const auto work = [&]
    {
        for (int k = next++; k < size(); k = next++)
        {
            try
            {
                call(k);
            }
            catch (...)
            {
                if (!failed.exchange(true)) thrown = std::current_exception();
            }
        }
    };
    std::vector<std::thread> helpers;
    for (int t = 1; t < m_threads; ++t) helpers.emplace_back(work);
    work();
    for (std::thread& helper : helpers) helper.join();
    if (thrown) std::rethrow_exception(thrown);
}

void Batch::step()
{
    eachWorld(
        [this](int k)
        {
            m_worlds[std::size_t(k)]->step();
            gather(k);
        });
}

void Batch::finish()
{
    for (const auto& world : m_worlds) world->finishStep();
}

const std::vector<double>& Batch::values(int body, BatchValue kind)
{
    const int nodes = nodeCount(body);
    const bool ofNodes = kind == BatchValue::nodePositions || kind == BatchValue::nodeVelocities;
    const BodyEntry& entry = m_worlds[0]->bodies()[body];
    if (ofNodes ? !entry.m_soft : !entry.m_rigid)
        throw std::invalid_argument("body " + std::to_string(body) + " is no " + (ofNodes ? "soft" : "rigid") +
                                    " body");
    for (const auto& known : m_values)
        if (known->m_body == body && known->m_kind == kind) return known->m_numbers;
    m_values.push_back(std::make_unique<Values>());
    Values& values = *m_values.back();
    values.m_body = body;
    values.m_kind = kind;
    values.m_numbers.resize(m_worlds.size() * std::size_t(nodes) * 3);
    for (int k = 0; k < size(); ++k) gather(k, values);
    return values.m_numbers;
}

void Batch::refresh()
{
    for (int k = 0; k < size(); ++k) gather(k);
}

void Batch::gather(int world)
{
    for (const auto& values : m_values) gather(world, *values);
}

void Batch::gather(int world, Values& values) const
{
    double* at = values.m_numbers.data() + values.m_numbers.size() / m_worlds.size() * std::size_t(world);
    const BodyEntry& entry = m_worlds[std::size_t(world)]->bodies()[values.m_body];
    if (entry.m_rigid)
    {
        const btRigidBody& body = *entry.m_rigid->m_body;
        append(values.m_kind == BatchValue::positions ? body.getWorldTransform().getOrigin() : body.getLinearVelocity(),
               at);
        return;
    }
    if (!entry.m_soft) return;  // it was removed, and the array keeps its last values
    const btSoftBody& body = *entry.m_soft->m_body;
    const std::size_t room = values.m_numbers.size() / m_worlds.size() / 3;
    for (int i = 0; i < body.m_nodes.size() && std::size_t(i) < room; ++i)
        append(values.m_kind == BatchValue::nodePositions ? body.m_nodes[i].m_x : body.m_nodes[i].m_v, at);
}

std::vector<std::vector<unsigned char>> Batch::states()
{
    std::vector<std::vector<unsigned char>> states(m_worlds.size());
    eachWorld([&](int k) { WorldState::save(*m_worlds[std::size_t(k)], states[std::size_t(k)]); });
    return states;
}

void Batch::restore(const std::vector<std::vector<unsigned char>>& states)
{
    eachWorld(
        [&](int k)
        {
            const std::vector<unsigned char>& state = states[std::size_t(k)];
            if (state.empty()) return;
            WorldState::restore(*m_worlds[std::size_t(k)], state.data(), state.size());
            gather(k);
        });
}

}  // namespace bullet_fem::python

// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "python/core/world.h"

namespace bullet_fem::python
{

/// A value of each node of a soft body, or of a rigid body, in all worlds.
enum class BatchValue
{
    nodePositions,   ///< [m]
    nodeVelocities,  ///< [m/s]
    positions,       ///< of a rigid body's centre of mass [m]
    velocities       ///< of a rigid body [m/s]
};

/// Worlds of equal bodies, stepped together by threads of their own. Results do not depend on the number of threads.
/// To be used with Python's lock, but for step().
class Batch
{
public:
    /// `threads`: 0 takes all of the machine's. Throws std::invalid_argument without worlds, if a world comes twice, or
    /// if bodies differ in kind or number of nodes.
    Batch(std::vector<std::shared_ptr<World>> worlds, int threads);

    int size() const { return int(m_worlds.size()); }
    int threads() const { return m_threads; }
    const std::vector<std::shared_ptr<World>>& worlds() const { return m_worlds; }
    /// Nodes of a soft body; 1 for a rigid one. Throws std::out_of_range.
    int nodeCount(int body) const;

    /// One step of every world, and the arrays of it. Call `finish` afterwards. Exceptions of the worlds are rethrown
    /// there.
    void step();
    void finish();

    /// Values in all worlds, `size()` times nodeCount(body) times 3; kept up to date by step() and restore(). Throws
    /// std::invalid_argument if the body is of the other kind.
    const std::vector<double>& values(int body, BatchValue kind);
    /// Renews all arrays after other changes.
    void refresh();

    std::vector<std::vector<unsigned char>> states();
    /// Restores world k to states[k]; leaves it if that is empty. Throws what a world throws, after the others.
    void restore(const std::vector<std::vector<unsigned char>>& states);

private:
    struct Values
    {
        int m_body;
        BatchValue m_kind;
        std::vector<double> m_numbers;
    };
    void eachWorld(const std::function<void(int)>& call);
    void gather(int world);
    void gather(int world, Values& values) const;

    std::vector<std::shared_ptr<World>> m_worlds;
    const int m_threads;
    std::vector<std::unique_ptr<Values>> m_values;
};

}  // namespace bullet_fem::python

// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <memory>
#include <vector>

#include "python/core/soft_maker.h"

namespace bullet_fem::python
{

/// Bodies that are baked once for all worlds that are built while it lives: equal meshes, materials, pins and steps
/// share one model and its factor. One at a time; to be used with Python's lock.
class SharedBodies
{
public:
    /// Throws std::runtime_error if there is another one.
    SharedBodies();
    ~SharedBodies();
    SharedBodies(const SharedBodies&) = delete;
    SharedBodies& operator=(const SharedBodies&) = delete;

    /// The baked body of a request. Null if none is shared now, and for bodies that cannot be: baked ones, and those
    /// with a material of their own for each element.
    static const BakedBody* find(const World& world, const SoftRequest& request);

private:
    struct Entry
    {
        std::vector<Vec3> m_positions;
        std::vector<Tet> m_tets;
        bool m_isCage = false;
        BakeSettings m_settings;
        BakedBody m_baked;
    };
    const BakedBody* baked(const SoftRequest& request, BakeSettings settings);

    std::vector<std::unique_ptr<Entry>> m_entries;
    static SharedBodies* s_present;
};

}  // namespace bullet_fem::python

// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <cstddef>
#include <functional>
#include <vector>

#include "LinearMath/btAlignedObjectArray.h"
#include "plugin/registry/btFemBodyRegistry.h"
#include "plugin/setup/btFemBodySetUp.h"
#include "plugin/stages/btFemContactGroup.h"
#include "plugin/stages/btFemSplitter.h"

class btSoftBody;

/// The objects that a saved state consists of.
struct btFemSnapshotScope
{
    btFemBodyRegistry& m_registry;
    btFemBodySetUp& m_setUp;
    btFemContactGroup& m_group;
    btFemSplitter& m_splitter;
    const btAlignedObjectArray<btSoftBody*>* m_worldBodies;  ///< bodies of the world stepped last; null: none was
                                                             ///< stepped
};

/// Writes the complete state of the FEM bodies of the world stepped last to `buffer`. Throws std::invalid_argument
/// within a step, or if no body refers to the world's broad phase.
void saveSnapshot(const btFemSnapshotScope& scope, std::vector<unsigned char>& buffer);

/// The call that restores a saved state and throws nothing. The objects of `scope` must live until then, unchanged but
/// for Bullet's pairs and rigid bodies. Throws std::invalid_argument with the reason unless the state is complete and
/// all of its bodies are in the world with equal elements and material.
std::function<void()> checkedSnapshot(const btFemSnapshotScope& scope, const unsigned char* data, std::size_t size);

// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <cstddef>
#include <vector>

#include "LinearMath/btAlignedObjectArray.h"
#include "plugin/registry/btFemBodyRegistry.h"
#include "plugin/setup/btFemBodySetUp.h"
#include "plugin/stages/btFemContactGroup.h"
#include "plugin/stages/btFemSplitter.h"

class btSoftBody;

/// What a state is taken of, and put back to.
struct btFemSnapshotScope
{
    btFemBodyRegistry& m_registry;
    btFemBodySetUp& m_setUp;
    btFemContactGroup& m_group;
    btFemSplitter& m_splitter;
    const btAlignedObjectArray<btSoftBody*>* m_worldBodies;  ///< of the world stepped last; null: none was stepped
};

/// Writes all that the next step depends on, of the FEM bodies of the world stepped last. Throws std::invalid_argument
/// within a step, or where no body knows the world's broad phase.
void saveSnapshot(const btFemSnapshotScope& scope, std::vector<unsigned char>& buffer);

/// Puts it back. Throws std::invalid_argument, saying why, before it has changed anything, unless it is whole and all
/// of its bodies are in the world, made of the same elements and material.
void restoreSnapshot(const btFemSnapshotScope& scope, const unsigned char* data, std::size_t size);

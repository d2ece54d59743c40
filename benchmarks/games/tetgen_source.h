// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <string>

namespace bullet_fem
{

/// TetGen's output for a mesh, in the form that btSoftBodyHelpers::CreateFromTetGenData takes.
struct TetGenSource
{
    std::string m_nodes, m_elements;
};

/// Reads one of the .inl files of Bullet's examples, whose functions getNodes() and getElements() return string
/// literals. Throws std::runtime_error if the file cannot be read or lacks one of them.
TetGenSource readTetGenSource(const std::string& path);

}  // namespace bullet_fem

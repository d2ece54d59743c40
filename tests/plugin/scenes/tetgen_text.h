// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <sstream>
#include <string>

#include "bullet_fem/fem/mesh/tet_mesh.h"

namespace bullet_fem
{

/// A mesh in the format of btSoftBodyHelpers::CreateFromTetGenData: indices from 0, all digits.
struct TetGenText
{
    explicit TetGenText(const TetMesh& mesh)
    {
        std::ostringstream nodes, elements;
        nodes.precision(17);
        nodes << mesh.nodeCount() << " 3 0 0\n";
        for (int i = 0; i < mesh.nodeCount(); ++i)
        {
            const Vec3& X = mesh.restPositions()[i];
            nodes << i << " " << X.x << " " << X.y << " " << X.z << "\n";
        }
        elements << mesh.tetCount() << " 4 0\n";
        for (int e = 0; e < mesh.tetCount(); ++e)
        {
            elements << e;
            for (const int i : mesh.tets()[e]) elements << " " << i;
            elements << "\n";
        }
        m_nodes = nodes.str();
        m_elements = elements.str();
    }

    std::string m_nodes, m_elements;
};

}  // namespace bullet_fem

// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors

// Any bytes give an error with a message, or a mesh that TetMesh accepts or rejects.
#include <cstdlib>
#include <stdexcept>

#include "bullet_fem/io/tet_mesh_file.h"

extern "C" int LLVMFuzzerTestOneInput(const unsigned char* bytes, std::size_t size)
{
    using namespace bullet_fem;
    try
    {
        const TetMeshFile file = readTetMesh(bytes, size, TetMeshFormat::BULLETFEM_FUZZ_READER);
        if (file.m_tets.empty() || file.m_nodeNumbers.size() != file.m_positions.size()) std::abort();
        for (const Tet& tet : file.m_tets)
            for (const int i : tet)
                if (i < 0 || static_cast<std::size_t>(i) >= file.m_positions.size()) std::abort();
        if (file.mesh().looseCount() != 0) std::abort();
    }
    catch (const std::runtime_error& error)
    {
        if (!*error.what()) std::abort();
    }
    catch (const std::invalid_argument& error)
    {
        if (!*error.what()) std::abort();
    }
    return 0;
}

// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors

// Any bytes give an error with a message, or polygons, whose indices the caller checks.
#include <cstdlib>
#include <stdexcept>

#include "io/surface/polygon_mesh.h"

extern "C" int LLVMFuzzerTestOneInput(const unsigned char* bytes, std::size_t size)
{
    using namespace bullet_fem;
    try
    {
        const PolygonMesh mesh = BULLETFEM_FUZZ_READER({reinterpret_cast<const char*>(bytes), size});
        if (!mesh.m_faceEnd.empty() && mesh.m_faceEnd.back() != mesh.m_corners.size()) std::abort();
    }
    catch (const std::runtime_error& error)
    {
        if (!*error.what()) std::abort();
    }
    return 0;
}

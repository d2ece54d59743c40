// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <cstring>
#include <string>

#include "bullet_fem/fem/baked/baked_body.h"
#include "bullet_fem/fem/mesh/generators.h"
#include "fem/baked/baked_header.h"
#include "io/temporary_folder.h"

namespace bullet_fem
{

/// A baked test body: its file has all kinds of sections.
struct BakedCase
{
    std::array<int, 3> m_cells = {2, 1, 1};
    FactorChoice m_choice = FactorChoice::full;
    bool m_surface = true;  ///< with an embedded surface and partly filled elements
};

/// A box of 1 m with nodes 0 and 1 pinned, of a damped material; with one embedded triangle if m_surface.
inline BakedBody bakeCase(const BakedCase& c = {})
{
    BakeSettings settings;
    settings.m_material.m_stiffnessDamping = 0.01;
    settings.m_pins = {0, 1};
    settings.m_choice = c.m_choice;
    Cage cage;
    cage.m_mesh = makeBox({1, 1, 1}, c.m_cells, {0.1, 0.2, 0.3});
    if (!c.m_surface) return bakeBody(cage.m_mesh, settings);
    cage.m_filled.assign(cage.m_mesh.tetCount(), 0.75);
    cage.m_massScale = 1.25;
    cage.m_embedding = {{0, {0.25, 0.25, 0.25, 0.25}}, {1, {0.5, 0.5, 0, 0}}, {2, {0, 0, 0.1, 0.9}}};
    const SurfaceMesh surface{std::vector<Vec3>(3), {{0, 1, 2}}};
    return bakeBody(cage, surface, settings);
}

/// A file's bytes.
inline std::string bytesOf(const BakedBody& body)
{
    const TemporaryFolder folder;
    writeBakedBody(folder.path("body.bfem"), body);
    return folder.read("body.bfem");
}

inline const unsigned char* rawBytes(const std::string& bytes)
{
    return reinterpret_cast<const unsigned char*>(bytes.data());
}

/// The bytes with corrected lengths and checksums, so that only the checks of the contents can fail.
inline std::string sealed(std::string bytes)
{
    BakedHeader header = {};
    std::memcpy(&header, bytes.data(), sizeof header);
    sealHeader(header, rawBytes(bytes) + sizeof header, bytes.size() - sizeof header);
    std::memcpy(&bytes[0], &header, sizeof header);
    return bytes;
}

/// The error message of reading them; "" if there is none.
inline std::string complaint(const std::string& bytes)
{
    std::string why;
    readBakedBody(rawBytes(bytes), bytes.size(), "memory", &why);
    return why;
}

}  // namespace bullet_fem

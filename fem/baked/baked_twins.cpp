// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// For engines without exceptions.
#include <string>

#include "bullet_fem/fem/baked/baked_body.h"
#include "fem/common/attempt.h"

namespace bullet_fem
{

bool bakeBody(const TetMesh& mesh, const BakeSettings& settings, BakedBody& body, std::string* why)
{
    return succeeds([&] { body = bakeBody(mesh, settings); }, why);
}

bool bakeBody(const Cage& cage, const SurfaceMesh& surface, const BakeSettings& settings, BakedBody& body,
              std::string* why)
{
    return succeeds([&] { body = bakeBody(cage, surface, settings); }, why);
}

bool writeBakedBody(const std::string& path, const BakedBody& body, std::string* why)
{
    return succeeds([&] { writeBakedBody(path, body); }, why);
}

bool readBakedBody(const std::string& path, BakedBody& body, std::string* why)
{
    return succeeds([&] { body = readBakedBody(path); }, why);
}

bool readBakedBody(const unsigned char* data, std::size_t size, BakedBody& body, std::string* why)
{
    return succeeds([&] { body = readBakedBody(data, size, "memory"); }, why);
}

bool inspectBakedBody(const std::string& path, BakedFileInfo& info, std::string* why)
{
    return succeeds([&] { info = inspectBakedBody(path); }, why);
}

}  // namespace bullet_fem

// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// The forms of an earlier version.
#include "bullet_fem/fem/baked/baked_body.h"

namespace bullet_fem
{
namespace
{

// Where `why` is null, the reason is not told.
template <class Value, class Call>
bool made(Value& value, std::string* why, const Call& call)
{
    std::string reason;
    Value result = call(reason);
    if (why) *why = reason;
    if (!reason.empty()) return false;
    value = std::move(result);
    return true;
}

}  // namespace

bool bakeBody(const TetMesh& mesh, const BakeSettings& settings, BakedBody& body, std::string* why)
{
    return made(body, why, [&](std::string& reason) { return bakeBody(mesh, settings, &reason); });
}

bool bakeBody(const Cage& cage, const SurfaceMesh& surface, const BakeSettings& settings, BakedBody& body,
              std::string* why)
{
    return made(body, why, [&](std::string& reason) { return bakeBody(cage, surface, settings, &reason); });
}

bool readBakedBody(const std::string& path, BakedBody& body, std::string* why)
{
    return made(body, why, [&](std::string& reason) { return readBakedBody(path, BakedLoading::mapped, &reason); });
}

bool readBakedBody(const unsigned char* data, std::size_t size, BakedBody& body, std::string* why)
{
    return made(body, why, [&](std::string& reason) { return readBakedBody(data, size, "memory", &reason); });
}

bool inspectBakedBody(const std::string& path, BakedFileInfo& info, std::string* why)
{
    return made(info, why, [&](std::string& reason) { return inspectBakedBody(path, &reason); });
}

}  // namespace bullet_fem

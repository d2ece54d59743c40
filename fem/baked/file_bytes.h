// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>

namespace bullet_fem
{

/// Bytes aligned to 64, alive as long as any copy of m_data.
struct FileBytes
{
    std::shared_ptr<const unsigned char> m_data;
    std::size_t m_size = 0;
};

/// The bytes of a file, mapped into memory or read. Throws std::runtime_error with reason and remedy.
FileBytes mapFile(const std::string& path);
FileBytes readFile(const std::string& path);

/// A copy of a byte array. Throws std::bad_alloc.
FileBytes copyBytes(const unsigned char* data, std::size_t size);

/// Length of a file [B]; throws std::runtime_error if it is missing or not a regular file.
std::uint64_t fileLength(const std::string& path);

}  // namespace bullet_fem

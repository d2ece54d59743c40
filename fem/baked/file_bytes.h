// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>

namespace bullet_fem
{

/// Bytes that start at a multiple of 64, and live as long as anybody has m_data.
struct FileBytes
{
    std::shared_ptr<const unsigned char> m_data;
    std::size_t m_size = 0;
};

/// A file's bytes: mapped into memory, or read. Throws std::runtime_error with the reason and what to do.
FileBytes mapFile(const std::string& path);
FileBytes readFile(const std::string& path);

/// A copy of bytes that lie somewhere. Throws std::bad_alloc.
FileBytes copyBytes(const unsigned char* data, std::size_t size);

/// Length of a file; throws std::runtime_error if it is missing or no regular file.
std::uint64_t fileLength(const std::string& path);

}  // namespace bullet_fem

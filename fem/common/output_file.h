// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <cstddef>
#include <cstdio>
#include <string>
#include <string_view>

#include "bullet_fem/fem/common/export.h"

namespace bullet_fem
{

/// Atomic file output: the file gets its name only when complete, so that a reader, a crash or a full disk never leaves
/// an incomplete file under it. Until then the bytes are in a unique `.part` file in the target's directory, removed by
/// the destructor or by removeUnfinishedFiles. Devices and pipes are written to directly.
///
/// Errors throw std::runtime_error with the path, the system's reason and the remedy; an existing file of the name is
/// then unchanged.
class BULLETFEM_API OutputFile
{
public:
    /// Creates the `.part` file. Throws std::runtime_error.
    explicit OutputFile(std::string path);
    ~OutputFile();
    OutputFile(const OutputFile&) = delete;
    OutputFile& operator=(const OutputFile&) = delete;

    /// Appends bytes. Throws std::runtime_error.
    void write(const void* bytes, std::size_t size);
    /// Waits until all bytes are on the disk; without it a power failure could leave the name without them. Throws
    /// std::runtime_error.
    void sync();
    /// Renames the file to its final name, replacing an existing one. No writing is possible afterwards. Throws
    /// std::runtime_error.
    void commit();

    const std::string& path() const { return m_path; }
    /// The path that holds the bytes until `commit`, for another program that writes them.
    const std::string& temporaryPath() const { return m_temporary; }
    /// Throws std::runtime_error: "cannot write '<path>': <why>".
    [[noreturn]] void fail(const std::string& why) const;

private:
    [[noreturn]] void failAsTold(int error) const;

    std::string m_path, m_temporary;
    std::FILE* m_file = nullptr;
    bool m_pending = false;  // true while there is a .part file
    int m_unfinished = -1;   // index in the list of unfinished files
};

/// Writes bytes to a file through OutputFile. Throws std::runtime_error.
BULLETFEM_API void writeOutputFile(const std::string& path, std::string_view bytes);

/// Throws as OutputFile does if the path is not writable, for a check before long computations. Leaves no file behind.
BULLETFEM_API void checkWritable(const std::string& path);

}  // namespace bullet_fem

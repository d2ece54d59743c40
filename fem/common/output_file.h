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

/// A file that gets its name only when it is whole, so that a reader, a crash or a full disk never leaves half a file
/// under it. Until then it is a `.part` of its own beside its place, and is removed with this object, or by
/// removeUnfinishedFiles. Devices and pipes are written to as they are.
///
/// What fails throws std::runtime_error with the path, the system's reason and what to do; an older file of the name is
/// then as it was.
class BULLETFEM_API OutputFile
{
public:
    /// Makes the `.part`.
    explicit OutputFile(std::string path);
    ~OutputFile();
    OutputFile(const OutputFile&) = delete;
    OutputFile& operator=(const OutputFile&) = delete;

    /// Appends bytes.
    void write(const void* bytes, std::size_t size);
    /// Waits until all bytes are on the disk, or a power failure could leave the name without them.
    void sync();
    /// Gives the file its name, in place of what had it. Nothing can be written then.
    void commit();

    const std::string& path() const { return m_path; }
    /// Where the bytes are until `commit`, for another program that writes them instead.
    const std::string& temporaryPath() const { return m_temporary; }
    /// Throws: "cannot write '<path>': <why>".
    [[noreturn]] void fail(const std::string& why) const;

private:
    [[noreturn]] void failAsTold(int error) const;

    std::string m_path, m_temporary;
    std::FILE* m_file = nullptr;
    bool m_pending = false;  // whether there is a .part
    int m_unfinished = -1;   // its place among unfinished files
};

/// Writes an OutputFile of these bytes.
BULLETFEM_API void writeOutputFile(const std::string& path, std::string_view bytes);

/// Throws as OutputFile does if no file can be made there: before work whose result goes there. Nothing is left.
BULLETFEM_API void checkWritable(const std::string& path);

}  // namespace bullet_fem

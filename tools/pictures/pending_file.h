// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <string>

namespace bullet_fem
{

/// A file that gets its name only when it is whole. Until then it stands beside its place under another name, and is
/// removed with this object.
class PendingFile
{
public:
    /// Makes the temporary file. Throws std::runtime_error naming `path` if none can be made there.
    explicit PendingFile(std::string path);
    ~PendingFile();
    PendingFile(const PendingFile&) = delete;
    PendingFile& operator=(const PendingFile&) = delete;

    const std::string& path() const { return m_path; }
    const std::string& temporaryPath() const { return m_temporary; }
    /// Gives the file its name, over a file that has it. Throws std::runtime_error naming the path if that fails.
    void commit();
    /// Throws std::runtime_error: "cannot write '<path>': <why>".
    [[noreturn]] void fail(const std::string& why) const;

private:
    std::string m_path, m_temporary;
    bool m_pending = false;
};

}  // namespace bullet_fem

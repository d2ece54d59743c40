// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "tools/pictures/pending_file.h"

#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <system_error>
#include <utility>

namespace bullet_fem
{

PendingFile::PendingFile(std::string path) : m_path(std::move(path))
{
    m_temporary = m_path + "." + std::to_string(getpid()) + ".part";
    if (m_path.empty()) throw std::runtime_error("cannot write a file without a name");
    if (std::filesystem::is_directory(m_path)) fail("it is a folder");
    errno = 0;
    if (!std::ofstream(m_temporary, std::ios::binary)) fail(std::strerror(errno));
    m_pending = true;
}

PendingFile::~PendingFile()
{
    std::error_code ignored;
    if (m_pending) std::filesystem::remove(m_temporary, ignored);
}

void PendingFile::commit()
{
    std::error_code error;
    std::filesystem::rename(m_temporary, m_path, error);
    if (error) fail(error.message());
    m_pending = false;
}

void PendingFile::fail(const std::string& why) const
{
    throw std::runtime_error("cannot write '" + m_path + "': " + why);
}

}  // namespace bullet_fem

// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "fem/common/output_file.h"

#ifdef _WIN32
#include <fcntl.h>
#include <io.h>
#include <sys/stat.h>
#else
#include <unistd.h>
#endif

#include <cerrno>
#include <filesystem>
#include <random>
#include <stdexcept>
#include <system_error>
#include <utility>

#include "fem/common/message.h"
#include "fem/common/unfinished_files.h"

namespace bullet_fem
{
namespace
{

// True if the path, with links resolved, is a device or pipe.
bool isDevice(const std::string& path)
{
    std::error_code ignored;
    const std::filesystem::file_status status = std::filesystem::status(path, ignored);
    return exists(status) && !is_regular_file(status) && !is_directory(status);
}

// Creates a new file for writing; returns null with errno if it exists or on error.
std::FILE* makeFile(const std::string& path)
{
#ifdef _WIN32  // its older C library does not support "x"
    const int file = _open(path.c_str(), _O_WRONLY | _O_CREAT | _O_EXCL | _O_BINARY, _S_IREAD | _S_IWRITE);
    return file < 0 ? nullptr : _fdopen(file, "wb");
#else
    return std::fopen(path.c_str(), "wbx");
#endif
}

// Waits until the file's bytes are on the disk.
bool flushToDisk(std::FILE* file)
{
#ifdef _WIN32
    return _commit(_fileno(file)) == 0;
#else
    return fsync(fileno(file)) == 0;
#endif
}

}  // namespace

OutputFile::OutputFile(std::string path) : m_path(std::move(path))
{
    std::error_code ignored;
    if (m_path.empty()) fail("it has no name; give one");
    if (std::filesystem::is_directory(m_path, ignored)) fail("it is a directory; give the name of a file");
    if (isDevice(m_path))
    {
        m_temporary = m_path;
        m_file = std::fopen(m_path.c_str(), "wb");
    }
    std::random_device random;
    for (int k = 0; k < 100 && m_temporary != m_path && !m_pending; ++k)
    {
        m_temporary = message(m_path, ".", std::hex, random(), ".part");
        m_unfinished = noteUnfinishedFile(m_temporary);
        m_file = makeFile(m_temporary);
        m_pending = m_file != nullptr;
        if (m_pending) break;
        const int error = errno;
        forgetUnfinishedFile(std::exchange(m_unfinished, -1));
        if (error != EEXIST) failAsTold(error);
    }
    if (!m_file) failAsTold(errno);
}

OutputFile::~OutputFile()
{
    if (m_file) std::fclose(m_file);
    if (m_pending) std::remove(m_temporary.c_str());
    forgetUnfinishedFile(m_unfinished);
}

void OutputFile::write(const void* bytes, std::size_t size)
{
    errno = 0;
    if (size > 0 && std::fwrite(bytes, 1, size, m_file) != size) failAsTold(errno);
}

void OutputFile::sync()
{
    errno = 0;
    if (std::fflush(m_file) != 0 || (m_pending && !flushToDisk(m_file))) failAsTold(errno);
}

void OutputFile::commit()
{
    errno = 0;
    if (std::fclose(std::exchange(m_file, nullptr)) != 0) failAsTold(errno);
    if (!m_pending) return;
    std::error_code error;
    std::filesystem::rename(m_temporary, m_path, error);
    if (error) failAsTold(error.value());
    forgetUnfinishedFile(std::exchange(m_unfinished, -1));
    m_pending = false;
}

void OutputFile::fail(const std::string& why) const
{
    throw std::runtime_error("cannot write '" + m_path + "': " + why);
}

void OutputFile::failAsTold(int error) const
{
    fail(std::generic_category().message(error != 0 ? error : EIO) +
         "; check that its folder is there and writable, and its disk not full");
}

void writeOutputFile(const std::string& path, std::string_view bytes)
{
    OutputFile file(path);
    file.write(bytes.data(), bytes.size());
    file.commit();
}

void checkWritable(const std::string& path)
{
    if (!isDevice(path)) OutputFile(std::string(path));
}

}  // namespace bullet_fem

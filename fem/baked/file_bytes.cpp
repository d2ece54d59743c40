// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "fem/baked/file_bytes.h"

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <random>
#include <stdexcept>

#if defined(__unix__) || defined(__APPLE__)
#define BULLETFEM_HAS_MMAP
#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>
#endif

#include "fem/aligned_floats.h"
#include "fem/message.h"

namespace bullet_fem
{
namespace
{

[[noreturn]] void fail(const std::string& what)
{
    throw std::runtime_error(what);
}

std::string systemReason()
{
    return std::strerror(errno);
}

// Room for so many bytes.
std::shared_ptr<unsigned char> allocateBytes(std::size_t size)
{
    const auto floats = std::make_shared<AlignedFloats>(allocateFloats(size / sizeof(float) + 1));
    return {floats, reinterpret_cast<unsigned char*>(floats->get())};
}

}  // namespace

std::uint64_t fileLength(const std::string& path)
{
    std::error_code error;
    const std::filesystem::file_status status = std::filesystem::status(path, error);
    if (!std::filesystem::exists(status)) fail("there is no such file, or its folder may not be looked into");
    if (!std::filesystem::is_regular_file(status)) fail("it is a directory or device, not a file");
    const std::uint64_t length = std::filesystem::file_size(path, error);
    if (error) fail("its length cannot be told: " + error.message());
    return length;
}

FileBytes readFile(const std::string& path)
{
    const std::uint64_t length = fileLength(path);
    const std::shared_ptr<unsigned char> data = allocateBytes(length);
    std::ifstream file(path, std::ios::binary);
    file.read(reinterpret_cast<char*>(data.get()), static_cast<std::streamsize>(length));
    if (!file) fail("it cannot be opened or read; check its permissions");
    return {data, static_cast<std::size_t>(length)};
}

#ifdef BULLETFEM_HAS_MMAP
FileBytes mapFile(const std::string& path)
{
    fileLength(path);  // before open, which would wait at a pipe
    const int file = open(path.c_str(), O_RDONLY | O_CLOEXEC);
    if (file < 0) fail("it cannot be opened: " + systemReason() + "; check its permissions");
    struct stat status = {};
    const std::size_t size = fstat(file, &status) == 0 ? static_cast<std::size_t>(status.st_size) : 0;
#ifdef MAP_POPULATE
    constexpr int kFlags = MAP_PRIVATE | MAP_POPULATE;  // one call in place of a fault for every few pages
#else
    constexpr int kFlags = MAP_PRIVATE;
#endif
    void* const address = size > 0 ? mmap(nullptr, size, PROT_READ, kFlags, file, 0) : nullptr;
    close(file);
    if (address == MAP_FAILED) return readFile(path);  // some file systems cannot
    const auto unmap = [size](const unsigned char* data)
    {
        if (data) munmap(const_cast<unsigned char*>(data), size);
    };
    return {std::shared_ptr<const unsigned char>(static_cast<const unsigned char*>(address), unmap), size};
}
#else
FileBytes mapFile(const std::string& path)
{
    return readFile(path);
}
#endif

FileBytes copyBytes(const unsigned char* data, std::size_t size)
{
    const std::shared_ptr<unsigned char> copy = allocateBytes(size);
    if (size > 0) std::memcpy(copy.get(), data, size);
    return {copy, size};
}

namespace
{

// A file of its own beside another one, gone with this unless it has taken its name.
class FileBeside
{
public:
    explicit FileBeside(const std::string& path)
    {
        std::random_device random;
        for (int k = 0; k < 100 && !m_file; ++k)
        {
            m_name = message(path, ".", std::hex, random(), ".part");
            m_file = std::fopen(m_name.c_str(), "wbx");
            if (!m_file && errno != EEXIST) break;
        }
        if (!m_file) fail("a file beside it cannot be made: " + systemReason() + "; check that its folder is writable");
    }
    ~FileBeside()
    {
        if (m_file) std::fclose(m_file);
        if (!m_name.empty()) std::remove(m_name.c_str());
    }
    FileBeside(const FileBeside&) = delete;
    FileBeside& operator=(const FileBeside&) = delete;

    void write(const unsigned char* data, std::size_t size)
    {
        bool whole = std::fwrite(data, 1, size, m_file) == size && std::fflush(m_file) == 0;
#ifdef BULLETFEM_HAS_MMAP
        whole = whole && fsync(fileno(m_file)) == 0;  // or the name could outlive a power failure, and the bytes not
#endif
        std::string reason = whole ? "" : systemReason();
        if (std::fclose(m_file) != 0 && whole) whole = false, reason = systemReason();
        m_file = nullptr;
        if (!whole) fail(reason + "; check that its disk is not full");
    }

    void take(const std::string& path)
    {
        std::error_code error;
        std::filesystem::rename(m_name, path, error);
        if (error) fail("it cannot be replaced: " + error.message() + "; check that its folder is writable");
        m_name.clear();
    }

private:
    std::string m_name;
    std::FILE* m_file = nullptr;
};

}  // namespace

void replaceFile(const std::string& path, const unsigned char* data, std::size_t size)
{
    std::error_code ignored;
    const std::filesystem::file_status status = std::filesystem::status(path, ignored);
    if (std::filesystem::exists(status) && !std::filesystem::is_regular_file(status))
        fail("it is a directory or device; give the name of a file");
    FileBeside beside(path);
    beside.write(data, size);
    beside.take(path);
}

}  // namespace bullet_fem

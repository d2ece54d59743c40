// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "fem/baked/file_bytes.h"

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <system_error>

#ifdef _WIN32
#ifndef NOMINMAX
#define NOMINMAX
#endif
#define WIN32_LEAN_AND_MEAN
#include <windows.h>
#else
#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>
#endif

#include "fem/common/aligned_array.h"

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
#ifdef _WIN32
    return std::system_category().message(static_cast<int>(GetLastError()));
#else
    return std::strerror(errno);
#endif
}

// Allocates aligned memory.
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

#ifdef _WIN32
FileBytes mapFile(const std::string& path)
{
    fileLength(path);
    constexpr DWORD kShared = FILE_SHARE_READ | FILE_SHARE_WRITE | FILE_SHARE_DELETE;
    const HANDLE file =
        CreateFileA(path.c_str(), GENERIC_READ, kShared, nullptr, OPEN_EXISTING, FILE_ATTRIBUTE_NORMAL, nullptr);
    if (file == INVALID_HANDLE_VALUE) fail("it cannot be opened: " + systemReason() + "; check its permissions");
    LARGE_INTEGER length = {};
    const std::size_t size = GetFileSizeEx(file, &length) ? static_cast<std::size_t>(length.QuadPart) : 0;
    const HANDLE mapping = size > 0 ? CreateFileMappingA(file, nullptr, PAGE_READONLY, 0, 0, nullptr) : nullptr;
    void* const address = mapping ? MapViewOfFile(mapping, FILE_MAP_READ, 0, 0, 0) : nullptr;
    if (mapping) CloseHandle(mapping);  // the view keeps file and mapping alive
    CloseHandle(file);
    if (size > 0 && !address) return readFile(path);  // some file systems cannot map
    const auto unmap = [](const unsigned char* data)
    {
        if (data) UnmapViewOfFile(data);
    };
    return {std::shared_ptr<const unsigned char>(static_cast<const unsigned char*>(address), unmap), size};
}
#else
FileBytes mapFile(const std::string& path)
{
    fileLength(path);  // before open, which would wait at a pipe
    const int file = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
    if (file < 0) fail("it cannot be opened: " + systemReason() + "; check its permissions");
    struct stat status = {};
    const std::size_t size = fstat(file, &status) == 0 ? static_cast<std::size_t>(status.st_size) : 0;
#ifdef MAP_POPULATE
    constexpr int kFlags = MAP_PRIVATE | MAP_POPULATE;  // one call instead of a page fault for every few pages
#else
    constexpr int kFlags = MAP_PRIVATE;
#endif
    void* const address = size > 0 ? mmap(nullptr, size, PROT_READ, kFlags, file, 0) : nullptr;
    close(file);
    if (address == MAP_FAILED) return readFile(path);  // some file systems cannot map
    const auto unmap = [size](const unsigned char* data)
    {
        if (data) munmap(const_cast<unsigned char*>(data), size);
    };
    return {std::shared_ptr<const unsigned char>(static_cast<const unsigned char*>(address), unmap), size};
}
#endif

FileBytes copyBytes(const unsigned char* data, std::size_t size)
{
    const std::shared_ptr<unsigned char> copy = allocateBytes(size);
    if (size > 0) std::memcpy(copy.get(), data, size);
    return {copy, size};
}

}  // namespace bullet_fem

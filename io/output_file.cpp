// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "io/output_file.h"

#include <cerrno>
#include <cstdio>
#include <filesystem>
#include <stdexcept>
#include <system_error>

namespace bullet_fem
{
namespace
{

[[noreturn]] void fail(const std::string& path, const std::error_code& error)
{
    throw std::runtime_error("cannot write '" + path + "': " + error.message() +
                             "; check that its folder is writable and its disk not full");
}

std::error_code lastError()
{
    return {errno != 0 ? errno : EIO, std::generic_category()};
}

std::error_code writeTo(const std::string& path, std::string_view bytes, bool& opened)
{
    errno = 0;
    std::FILE* file = std::fopen(path.c_str(), "wb");
    opened = file != nullptr;
    if (!opened) return lastError();
    std::error_code error;
    const bool written = bytes.empty() || std::fwrite(bytes.data(), 1, bytes.size(), file) == bytes.size();
    if (!written || std::fflush(file) != 0) error = lastError();
    if (std::fclose(file) != 0 && !error) error = lastError();
    return error;
}

}  // namespace

void writeOutputFile(const std::string& path, std::string_view bytes)
{
    namespace fs = std::filesystem;
    std::error_code ignored;
    bool opened = false;
    const fs::file_status status = fs::status(path, ignored);  // of what a link points to
    if (fs::is_directory(status)) fail(path, std::make_error_code(std::errc::is_a_directory));
    if (fs::exists(status) && !fs::is_regular_file(status))
    {
        if (const std::error_code error = writeTo(path, bytes, opened)) fail(path, error);
        return;
    }
    const std::string part = path + ".part";
    std::error_code error = writeTo(part, bytes, opened);
    if (!error) fs::rename(part, path, error);
    if (!error) return;
    if (opened) fs::remove(part, ignored);
    fail(path, error);
}

}  // namespace bullet_fem

// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "bullet_fem/io/vtu_writer.h"

#include <charconv>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <utility>

#include "fem/message.h"

namespace bullet_fem
{
namespace
{

constexpr int kTriangleCellType = 5;  // VTK_TRIANGLE
constexpr int kDigits = 9;            // those of a float, which is what Bullet knows

/// Text that grows; numbers come out alike in every locale.
struct Text
{
    std::string m_text;

    Text& operator<<(const std::string& s) { return m_text += s, *this; }
    Text& operator<<(int i) { return *this << std::to_string(i); }
    Text& operator<<(double d)
    {
        char digits[32];
        const auto end = std::to_chars(digits, digits + sizeof digits, d, std::chars_format::general, kDigits).ptr;
        m_text.append(digits, end);
        return *this;
    }
};

void writeFile(const std::string& path, const std::string& text)
{
    std::ofstream file(path, std::ios::binary);
    file << text << std::flush;
    file.close();
    if (!file)
        throw std::runtime_error("cannot write '" + path +
                                 "': check that its folder is writable and its disk not full");
}

void checkName(const std::string& name)
{
    constexpr const char* allowed = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789._-";
    if (name.empty() || name.find_first_not_of(allowed) != std::string::npos)
        reject("VtuSeries: the name is '", name, "'; it must be letters, digits, '.', '_' and '-' only");
}

void checkFinite(const char* what, const std::vector<Vec3>& vectors)
{
    for (std::size_t i = 0; i < vectors.size(); ++i)
        if (!isFinite(vectors[i])) reject("VtuSeries: the ", what, " of vertex ", i, " is not finite");
}

void checkFrame(double time, const std::vector<Vec3>& positions, const std::vector<Triangle>& triangles,
                const std::vector<Vec3>& displacement)
{
    if (!std::isfinite(time)) reject("VtuSeries: the time is ", time, " s; it must be finite");
    if (!displacement.empty() && displacement.size() != positions.size())
        reject("VtuSeries: ", displacement.size(), " displacements for ", positions.size(),
               " vertices; give as many, or none");
    checkFinite("position", positions);
    checkFinite("displacement", displacement);
    for (std::size_t t = 0; t < triangles.size(); ++t)
        for (const int v : triangles[t])
            if (v < 0 || static_cast<std::size_t>(v) >= positions.size())
                reject("VtuSeries: triangle ", t, " uses vertex ", v, ", which is not in [0, ", positions.size(), ")");
}

void appendVectors(Text& text, const std::string& name, const std::vector<Vec3>& vectors)
{
    text << "<DataArray type=\"Float64\" Name=\"" << name << "\" NumberOfComponents=\"3\" format=\"ascii\">\n";
    for (const Vec3& v : vectors) text << v.x << " " << v.y << " " << v.z << "\n";
    text << "</DataArray>\n";
}

void appendTriangles(Text& text, const std::vector<Triangle>& triangles)
{
    const int count = static_cast<int>(triangles.size());
    text << "<Cells>\n<DataArray type=\"Int32\" Name=\"connectivity\" format=\"ascii\">\n";
    for (const Triangle& t : triangles) text << t[0] << " " << t[1] << " " << t[2] << "\n";
    text << "</DataArray>\n<DataArray type=\"Int64\" Name=\"offsets\" format=\"ascii\">\n";
    for (int i = 1; i <= count; ++i) text << std::to_string(3LL * i) << "\n";
    text << "</DataArray>\n<DataArray type=\"UInt8\" Name=\"types\" format=\"ascii\">\n";
    for (int i = 0; i < count; ++i) text << kTriangleCellType << "\n";
    text << "</DataArray>\n</Cells>\n";
}

std::string frameFile(const std::string& name, std::size_t frame)
{
    const std::string number = std::to_string(frame);
    return name + "_" + std::string(number.size() < 6 ? 6 - number.size() : 0, '0') + number + ".vtu";
}

/// Replaces the .pvd as one act, so that a reader or a crash never meets half a file.
void writePvd(const std::string& path, const std::string& name, const std::vector<double>& times)
{
    Text text;
    text << "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"1.0\">\n<Collection>\n";
    for (std::size_t i = 0; i < times.size(); ++i)
        text << "<DataSet timestep=\"" << times[i] << "\" part=\"0\" file=\"" << frameFile(name, i) << "\"/>\n";
    text << "</Collection>\n</VTKFile>\n";
    writeFile(path + ".part", text.m_text);
    std::error_code error;
    std::filesystem::rename(path + ".part", path, error);
    if (error) throw std::runtime_error("cannot write '" + path + "': " + error.message());
}

}  // namespace

VtuSeries::VtuSeries(std::string folder, std::string name) : m_folder(std::move(folder)), m_name(std::move(name))
{
    checkName(m_name);
    std::error_code error;
    std::filesystem::create_directories(m_folder, error);
    if (!std::filesystem::is_directory(m_folder))
        throw std::runtime_error("cannot make the folder '" + m_folder +
                                 "': " + (error ? error.message() : std::string("a file has this name")));
    writePvd(pvdPath(), m_name, m_times);  // finds out now whether files can be written here
}

std::string VtuSeries::pvdPath() const
{
    return (std::filesystem::path(m_folder) / (m_name + ".pvd")).string();
}

void VtuSeries::writeTriangles(double time, const std::vector<Vec3>& positions, const std::vector<Triangle>& triangles,
                               const std::vector<Vec3>& displacement)
{
    checkFrame(time, positions, triangles, displacement);
    Text text;
    text << "<?xml version=\"1.0\"?>\n<VTKFile type=\"UnstructuredGrid\" version=\"1.0\">\n<UnstructuredGrid>\n";
    text << "<Piece NumberOfPoints=\"" << std::to_string(positions.size()) << "\" NumberOfCells=\""
         << std::to_string(triangles.size()) << "\">\n<PointData";
    text << (displacement.empty() ? ">\n" : " Vectors=\"displacement\">\n");
    if (!displacement.empty()) appendVectors(text, "displacement", displacement);
    text << "</PointData>\n<Points>\n";
    appendVectors(text, "Points", positions);
    text << "</Points>\n";
    appendTriangles(text, triangles);
    text << "</Piece>\n</UnstructuredGrid>\n</VTKFile>\n";
    writeFile((std::filesystem::path(m_folder) / frameFile(m_name, m_times.size())).string(), text.m_text);

    std::vector<double> times = m_times;  // a frame counts only once the .pvd has it
    times.push_back(time);
    writePvd(pvdPath(), m_name, times);
    m_times = std::move(times);
}

}  // namespace bullet_fem

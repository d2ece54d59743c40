// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "bullet_fem/io/vtu_writer.h"

#include <filesystem>
#include <stdexcept>
#include <utility>

#include "fem/common/message.h"
#include "fem/common/output_file.h"
#include "io/frames/body_frame_check.h"
#include "io/frames/vtu_frame.h"
#include "io/text/written_number.h"

namespace bullet_fem
{
namespace
{

void checkName(const std::string& name)
{
    constexpr const char* allowed = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789._-";
    if (name.empty() || name.find_first_not_of(allowed) != std::string::npos)
        reject("VtuSeries: the name is '", name, "'; it must be letters, digits, '.', '_' and '-' only");
}

std::string frameFile(const std::string& name, std::size_t frame)
{
    const std::string number = std::to_string(frame);
    return name + "_" + std::string(number.size() < 6 ? 6 - number.size() : 0, '0') + number + ".vtu";
}

void writePvd(const std::string& path, const std::string& name, const std::vector<double>& times)
{
    std::string xml = "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"1.0\">\n<Collection>\n";
    for (std::size_t i = 0; i < times.size(); ++i)
        xml +=
            "<DataSet timestep=\"" + writtenNumber(times[i]) + "\" part=\"0\" file=\"" + frameFile(name, i) + "\"/>\n";
    xml += "</Collection>\n</VTKFile>\n";
    writeOutputFile(path, xml);
}

}  // namespace

VtuSeries::VtuSeries(std::string folder, std::string name, VtuEncoding encoding)
    : m_folder(std::move(folder)), m_name(std::move(name)), m_encoding(encoding)
{
    checkName(m_name);
    std::error_code error;
    std::filesystem::create_directories(m_folder, error);
    if (!std::filesystem::is_directory(m_folder))
        throw std::runtime_error("cannot make the folder '" + m_folder +
                                 "': " + (error ? error.message() : std::string("a file has this name")));
    writePvd(pvdPath(), m_name, m_times);  // fails early if files cannot be written here
}

std::string VtuSeries::pvdPath() const
{
    return (std::filesystem::path(m_folder) / (m_name + ".pvd")).string();
}

void VtuSeries::writeBodies(double time, const std::vector<BodyFrame>& bodies)
{
    write(time, bodies, true);
}

void VtuSeries::writeTriangles(double time, const std::vector<Vec3>& positions, const std::vector<Triangle>& triangles,
                               const std::vector<Vec3>& displacement)
{
    BodyFrame body;
    body.m_positions = positions;
    body.m_triangles = triangles;
    body.m_displacement = displacement;
    write(time, {body}, false);
}

void VtuSeries::write(double time, const std::vector<BodyFrame>& bodies, bool named)
{
    checkTime("VtuSeries", time);
    checkFrame("VtuSeries", bodies);
    writeOutputFile((std::filesystem::path(m_folder) / frameFile(m_name, m_times.size())).string(),
                    vtuFrame(bodies, m_encoding, named));
    std::vector<double> times = m_times;  // a frame counts only once the .pvd has it
    times.push_back(time);
    writePvd(pvdPath(), m_name, times);
    m_times = std::move(times);
}

}  // namespace bullet_fem

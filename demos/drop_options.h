// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <optional>
#include <string>

namespace bullet_fem
{

/// User options. Lengths are those of the scene, after scaling.
struct DropOptions
{
    std::string m_meshFile;  ///< OFF, OBJ, STL or PLY
    std::string m_outputFolder = "out/drop";
    double m_scale = 0;             ///< multiplies the file's positions [-]; 0: the longest side becomes 1 m
    double m_cellSize = 0;          ///< edge of a lattice cube [m]; 0: for about 5000 tets
    double m_youngModulus = 1e6;    ///< E [Pa], in [1, 1e13]
    double m_poissonRatio = 0.4;    ///< nu [-], in [0, 0.499]
    double m_density = 1000;        ///< rho [kg/m3], in [1, 1e6]
    double m_seconds = 4;           ///< simulated time [s], in [1e-4, 3600]
    double m_step = 1.0 / 60;       ///< h [s], in [1e-4, 0.1]
    double m_framesPerSecond = 30;  ///< frame rate of the written series [1/s], in [0.01, 1e4]
};

/// Reads the command line; the last value of a repeated option applies. Returns an exit code if the program is to end
/// now: 0 after --help, 2 after a message on stderr about an invalid option.
std::optional<int> parseOptions(int argc, char** argv, DropOptions& options);

}  // namespace bullet_fem

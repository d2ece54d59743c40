// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "bullet_fem/fem/common/vec3.h"
#include "bullet_fem/fem/mesh/material.h"
#include "bullet_fem/fem/mesh/tet_mesh.h"

namespace bullet_fem
{

/// The dynamic clamped beam that every method of the benchmark runs: 4 x 1 x 1 m along x, cells split into six tets
/// around the diagonal (0,0,0)-(1,1,1), clamped at x = 0, falling from rest under its own weight.
struct BeamCase
{
    std::vector<Vec3> m_positions;    ///< rest positions X [m]
    std::vector<Tet> m_tets;          ///< elements of positive orientation
    std::vector<int> m_clampedNodes;  ///< nodes that never move
    int m_tipNode = 0;                ///< the node at (4, 0, 0) whose height z is reported
    Material m_material;              ///< E, nu, rho, alpha, beta
    Vec3 m_gravity = {0, 0, -9.81};   ///< g [m/s2]
    double m_step = 1.0 / 60;         ///< h [s], > 0
    int m_steps = 60;                 ///< steps to run, >= 1
};

/// Results of one method for a BeamCase. Arrays have one entry per step.
struct BeamRun
{
    std::string m_method;
    double m_tolerance = 0;         ///< the method's own setting [-]; 0 if it has none or keeps its default
    bool m_sameModel = true;        ///< false: another physical model; residual and tip error are then not comparable
    double m_residualBound = 1e-3;  ///< |b - A dv| / |b| [-] up to which the run counts as solved
    double m_tipBound = 1e-3;       ///< relative tip error [-] up to which the run counts as accurate
    double m_mass = 0;              ///< mass of the free nodes [kg]
    double m_setupSeconds = 0;      ///< everything before the first step [s]
    std::size_t m_heapBytes = 0;    ///< heap in use after the last step by all data of the method [B]; 0 if unknown
    std::size_t m_factorBytes = 0;  ///< of the packed factor [B]; 0 without a factor
    std::vector<double> m_stepSeconds;  ///< wall time of the step alone [s]
    std::vector<double> m_cpuSeconds;   ///< processor time of the thread for the step [s]
    std::vector<int> m_iterations;      ///< CG iterations, 1 for the direct mode
    std::vector<double> m_residuals;    ///< true |b - A dv| / |b| after the solve [-]; empty for other models
    std::vector<double> m_tipHeights;   ///< z of the tip node after the step [m]
};

/// The beam with cubic cells of side 1 / cellsPerMetre [m], cellsPerMetre in [1, 32]: 24 cellsPerMetre^3 tets.
/// Throws std::invalid_argument.
BeamCase makeBeamCase(int cellsPerMetre, const Material& material);

/// Cells per metre, in [1, 32], of a beam of `tets` = 24 n^3 elements. Throws std::invalid_argument if no such n
/// exists.
int beamCells(int tets);

/// Lumped node masses [kg], rho V / 4 from each tet at a node, including clamped nodes.
std::vector<double> lumpedNodeMasses(const BeamCase& beam);

}  // namespace bullet_fem

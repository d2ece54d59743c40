// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <string>
#include <vector>

#include "plugin/scenes/random_program.h"

namespace bullet_fem
{

/// A random program: its parameters, and the numbers of its acts.
struct SoakCase
{
    WorldClass m_world = WorldClass::softRigid;
    Coupling m_coupling = Coupling::swap;
    Manner m_manner = Manner::hostile;
    unsigned m_number = 1;
    std::vector<int> m_acts;  ///< ascending
};

/// The `k`-th case of a soak: it cycles through worlds, couplings and manners, with `acts` acts.
SoakCase soakCase(unsigned k, int acts);

/// The case's name, for the command that repeats it: "softRigid coupled gentle 17".
std::string nameOf(const SoakCase& soak);

/// The result of a case.
struct SoakOutcome
{
    std::string m_fault;  ///< first fault and its place; empty if none
    long m_steps = 0;     ///< world steps
    int m_refusals = 0;   ///< rejected bad inputs
};

/// Runs a case in this process, and checks the world after each act that steps it: numbers are finite; for a gentle
/// program also that nothing is faster than 100 m/s, no soft body's centre is below the floor, no flags are set but
/// those of crushing or of repeated work, and a restored state is continued bitwise equal. `watch`, if any, is called
/// after each act.
SoakOutcome run(const SoakCase& soak, void (*watch)(int act, RandomProgram& program) = nullptr);

}  // namespace bullet_fem

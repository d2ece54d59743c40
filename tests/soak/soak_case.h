// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <string>
#include <vector>

#include "plugin/scenes/random_program.h"

namespace bullet_fem
{

/// A random program: what makes it, and which of its acts are done.
struct SoakCase
{
    WorldClass m_world = WorldClass::softRigid;
    Coupling m_coupling = Coupling::swap;
    Manner m_manner = Manner::hostile;
    unsigned m_number = 1;
    std::vector<int> m_acts;  ///< ascending
};

/// The `k`-th case of a soak: worlds, couplings and manners in turns, with `acts` acts.
SoakCase soakCase(unsigned k, int acts);

/// What a case was, for the command that repeats it: "softRigid coupled gentle 17".
std::string nameOf(const SoakCase& soak);

/// How a case ended.
struct SoakOutcome
{
    std::string m_fault;  ///< what was wrong first, and where; empty if nothing
    long m_steps = 0;     ///< of the world
    int m_refusals = 0;   ///< of bad input
};

/// Runs a case in this process, and looks at the world after every act that steps it: numbers are finite; of a gentle
/// program nothing is faster than 100 m/s, no soft body's centre is below the floor, no flag but those that tell of
/// crushing or of work done anew, and a restored state goes the same way to the bit.
/// `watch`, if any, sees the program after every act.
SoakOutcome run(const SoakCase& soak, void (*watch)(int act, RandomProgram& program) = nullptr);

}  // namespace bullet_fem

// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <string>

#include "bullet_fem/fem/factor/body_model.h"

namespace bullet_fem
{

/// Cost of computing the rest factor of a model, by stage [s], and the factor's size.
struct SetupStages
{
    std::string m_ordering;   ///< library that found the order: AMD, METIS or Eigen
    double m_assembly = 0;    ///< A0 and its pattern
    double m_order = 0;       ///< fill-reducing order
    double m_tree = 0;        ///< supernodes
    double m_numeric = 0;     ///< factorization and packing
    double m_operations = 0;  ///< of a Cholesky factorization with these supernodes [flop]
    double m_fill = 0;        ///< entries of the factor over entries of A0's lower half [-]

    double total() const { return m_assembly + m_order + m_tree + m_numeric; }
};

/// Repeats the stages of BodyModel's factorization with timers and discards the factor. Throws as BodyModel::create
/// does.
SetupStages measureSetup(const BodyModel& model);

}  // namespace bullet_fem

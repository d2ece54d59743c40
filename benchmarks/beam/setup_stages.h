// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <string>

#include "bullet_fem/fem/factor/body_model.h"

namespace bullet_fem
{

/// What the rest factor of a model costs, stage by stage [s], and how large it gets.
struct SetupStages
{
    std::string m_ordering;   ///< what found the order: AMD, METIS or Eigen
    double m_assembly = 0;    ///< A0 and its pattern
    double m_order = 0;       ///< fill-reducing order
    double m_tree = 0;        ///< supernodes
    double m_numeric = 0;     ///< factorization and packing
    double m_operations = 0;  ///< of a Cholesky factorization with these supernodes [flop]
    double m_fill = 0;        ///< entries of the factor over entries of A0's lower half [-]

    double total() const { return m_assembly + m_order + m_tree + m_numeric; }
};

/// Goes through the stages of BodyModel's factor once more, with a watch in hand; the factor is thrown away. Throws as
/// BodyModel::create does.
SetupStages measureSetup(const BodyModel& model);

}  // namespace bullet_fem

// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <vector>

#include "bullet_fem/fem/body/body.h"
#include "bullet_fem/fem/body/node_reaction.h"
#include "bullet_fem/fem/common/export.h"

namespace bullet_fem
{

/// Reactions of the last step at all nodes of elements that were fixed in it, ascending by node (docs/theory.md,
/// Reactions). For every connected component with fixed nodes
///
///     h sum R_p + h sum f_i + sum J = p(end) - p(begin),
///
/// and correspondingly for angular momentum, with loads f_i at the midpoints of the nodes' motion and impulses J of
/// contacts and joints at their points of action, up to moments that forces at the fixed nodes cannot have: a single
/// node has none about itself, and nodes on a line none about the line. Loads f_i include mass damping.
///
/// Returns null if there were no fixed nodes, if the last step was abandoned, or if the body got another model since.
/// Computed in the first call after a step, by one product with A; call from one thread at a time. Allocates only if
/// there are more fixed nodes than before.
BULLETFEM_API const std::vector<NodeReaction>* reactions(const Body& body);

}  // namespace bullet_fem

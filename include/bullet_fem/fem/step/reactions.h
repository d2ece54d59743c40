// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <vector>

#include "bullet_fem/fem/body/body.h"
#include "bullet_fem/fem/body/node_reaction.h"
#include "bullet_fem/fem/common/export.h"

namespace bullet_fem
{

/// Reactions of the last step at all nodes of elements that it had fixed, ascending by
/// node (docs/theory.md, Reactions).
/// For every connected component that has fixed nodes
///
///     h sum R_p + h sum f_i + sum J = p(end) - p(begin),
///
/// and the same holds for angular momentum, with loads f_i at the middles of the nodes' ways and impulses of contact
/// and joints J where both sides feel them, as far as forces at the fixed nodes can have a moment: a single one has
/// none about itself, and those on a line none about that. Loads f_i include damping by mass.
///
/// Null if it had none, if the last step was abandoned, or if the body has another model since. Computed when first
/// asked for after a step, by one product with A: from one thread at a time. Allocates only when there are more fixed
/// nodes than before.
BULLETFEM_API const std::vector<NodeReaction>* reactions(const Body& body);

}  // namespace bullet_fem

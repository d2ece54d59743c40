// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <vector>

#include "bullet_bridge/contact/rigid/contact_list.h"

namespace bullet_fem
{

/// Turns contacts of vertices that have sunk in beside the seam of two convex shapes. A vertex is nearest to the face
/// within the seam, which is no surface of the two together: its contact is then that of a point before it, along
/// heldNormal[vertex], by which it was held in the last step, or into the body. Vertices deeper than the contact band
/// may have come from any side.
void turnFromInnerFaces(const SearchScope& scope, const std::vector<ContactTarget>& targets,
                        const std::vector<Vec3>& heldNormal, ContactList& near);

}  // namespace bullet_fem

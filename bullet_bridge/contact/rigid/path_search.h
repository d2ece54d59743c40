// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include "bullet_bridge/contact/rigid/flush_filter.h"
#include "bullet_bridge/contact/rigid/inner_faces.h"

/// Contacts of a body's surface with convex shapes on the paths within the step, which its carriers limit.
namespace bullet_fem
{

/// Appends contacts of a fast target as the step begins: nodes only; edges and triangles are searched on their paths.
void findTouchingNodes(SearchScope& scope, const InnerFaces& innerFaces, const ContactTarget& target,
                       ContactList& near);

/// Fast target: appends the contacts near it that are not flush, and those that the surface meets on its path.
void findOnPaths(SearchScope& scope, const ContactTarget& target, const ContactList& near, const FlushFilter& filter,
                 ContactList& list);

/// Slow target: appends the contacts near it that are not flush, and among candidates beyond the band those that the
/// surface meets on its path.
void confirmOnPaths(const SearchScope& scope, const ContactTarget& target, const ContactList& near,
                    const FlushFilter& filter, ContactList& list);

}  // namespace bullet_fem

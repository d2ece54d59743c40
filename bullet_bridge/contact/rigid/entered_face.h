// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include "bullet_bridge/contact/rigid/contact_target.h"

namespace bullet_fem
{

/// Turns the distance of a point of a feature from a movable convex target to the face that it entered the target
/// through, if another one is nearer: the opposite one, or one beside if the point is deeper below that than the
/// contact band. That face is the one of its contact in the last step, or the first on its straight way since then, as
/// the target saw it. `d`: less the contact offset, with the point's weights on the feature's corners.
void turnToEnteredFace(const SearchScope& scope, const ContactTarget& target, int feature, const Triangle& nodes,
                       SurfaceDistance& d);

/// The distance of a point that has sunk in against `held`, from where it came: from the nearest of the points farther
/// and farther back of which the shape is on that side. Over a rim that side is the plane through it. False if there is
/// none within the body's size.
bool distanceFromBefore(const SearchScope& scope, const ContactTarget& target, const Vec3& point, const Vec3& held,
                        SurfaceDistance& d);

/// Remembers the places of the body's vertices and of its movable convex targets for the next search.
void notePlaces(const std::vector<ContactTarget>& targets, FemSoftBody& fem);

}  // namespace bullet_fem

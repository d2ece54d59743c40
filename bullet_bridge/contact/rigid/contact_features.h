// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include "bullet_bridge/contact/rigid/contact_target.h"

namespace bullet_fem
{

/// Largest number of corners of a polyhedron: each triangle has as many feature numbers.
constexpr int kMaxCorners = 32;

/// Number of the first feature that stands for a corner of a shape over a triangle; see ContactOrigin::m_feature.
int firstCornerFeature(const FemSoftBody& fem);

/// The corners of a feature, the first repeated for nodes and edges; see ContactOrigin::m_feature.
Triangle cornersOf(const FemSoftBody& fem, const ContactTarget& target, int feature);

/// True if the contact point stays on the surface: a vertex, a midpoint or a centroid, not a nearest point.
bool isFixedPoint(const FemSoftBody& fem, const ContactTarget& target, int feature);

/// True if both nodes lie over one flat face of the shape: their normals agree, so their contacts suffice.
bool areOverOneFace(const FemSoftBody& fem, int a, int b);

/// True if the surface at a feature faces against the normal: one of its triangles does, their mean, or all of them
/// rise from it, as from a spike or the edge of a blade. A point beside a box that lies on the surface is near the
/// box's side wall, but its surface does not face that wall.
bool faces(const FemSoftBody& fem, const Triangle& nodes, const Vec3& normal);

/// Origin of a contact of a target with a feature.
ContactOrigin originOf(const ContactTarget& target, int feature);

/// The body's contact of this origin that overlapped as the last step began, or null.
const ContactPoint* deepContact(const FemSoftBody& fem, const ContactOrigin& origin);

/// The body's contact of this origin that pushed in the last step, or null.
const ContactPoint* pushingContact(const FemSoftBody& fem, const ContactOrigin& origin);

}  // namespace bullet_fem

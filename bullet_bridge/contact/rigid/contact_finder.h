// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include "bullet_bridge/contact/contact_reduction.h"
#include "bullet_bridge/contact/rigid/contact_matcher.h"
#include "bullet_bridge/contact/rigid/node_search.h"
#include "bullet_bridge/contact/rigid/path_search.h"
#include "bullet_bridge/contact/rigid/sheet_search.h"

namespace bullet_fem
{

/// Flags of a contact search.
struct ContactSearchReport
{
    bool m_unknownShape = false;  ///< a shape without contact support was left out
    bool m_limited = false;       ///< more contacts than permitted were found; they were thinned by place
    bool m_encloses = false;      ///< the middle of a solid object is inside the body
};

/// Records that Bullet's broad phase found the two overlapping, once. May be called by several threads at once.
void recordOverlap(FemSoftBody& fem, const btCollisionObject& object);
/// Records an overlap with another FEM body, on one body of the pair, once. May be called by several threads at once.
void recordOverlap(FemSoftBody& fem, const btSoftBody& other);

/// Finds the contacts of a FEM body's surface with the recorded objects, present or possible within the step.
/// Features: every shape is tested with surface nodes. Convex shapes are also tested with midpoints of edges and
/// triangles where the nodes do not all lie over one flat face, and with the nearest points of edges and triangles
/// where these are closer than all fixed points. Fixed points come first because the nearest point, and the contact
/// force with it, wanders where edges or faces are parallel. On triangles below the corners of a small polyhedron, the
/// corners replace the nearest point.
/// Gaps are measured between the surface as the step begins and the objects' poses; pairs that separate faster than
/// they could close within the step are left out (speculative contact). Impulses of the last step are the warm start.
///
/// Fast motion: if surface and shape move farther within the step than half a mesh edge or half the shape's thickness,
/// gaps and normals of its beginning are meaningless. Then a feature is a contact if the paths meet, with the normal at
/// that time (swept_distance.h). Separated pairs are contacts only if the paths meet, or would if others stop the
/// target.
///
/// Flush surfaces: paths are limited by present contacts (carried_motion.h), so a sliding vertex moves along its
/// carrier, a contact band above it, and does not hit the side of the next box. A side wall that does not rise above a
/// surface that carries the point is dropped. Objects that slide over soft bodies sink in; walls in front of their side
/// that rise little above the face that they lie on are dropped as well (CarryingPlane).
///
/// Concave shapes are sheets of two-sided triangles (SheetSearch).
///
/// Scratch grows with the surface and the number of triangles, never shrinks.
class ContactFinder
{
public:
    /// Call after solveFreeMotion. Replaces m_contacts and m_origins of fem.m_memory by those of this step, at most
    /// m_maxContacts, with m_soft.m_body = bodyIndex. Writes to `fem` only. Returns the search's flags.
    ContactSearchReport find(FemSoftBody& fem, int bodyIndex, const RigidSurroundings& around);

private:
    void findNear(ContactTarget& target);
    void findWithinStep(const ContactTarget& target);
    void turnToEnd(const ContactTarget& target, std::size_t first);
    void reserve();
    bool limit(const RigidSurroundings& around);
    void listForReduction(const RigidSurroundings& around, double cell);

    SearchScope m_scope;
    ContactTargets m_targets;
    ContactList m_near;   // contacts as the step begins, and candidates within the step
    ContactList m_found;  // those of the step
    NodeSearch m_nodes;
    SheetSearch m_sheets;
    FlushFilter m_filter;
    ContactMatcher m_matcher;
    ContactReduction m_reduction;
    std::vector<int> m_order;  // scratch
};

}  // namespace bullet_fem

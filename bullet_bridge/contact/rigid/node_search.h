// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <vector>

#include "bullet_bridge/contact/rigid/contact_list.h"
#include "bullet_bridge/contact/rigid/inner_faces.h"

namespace bullet_fem
{

/// Contacts of a body's surface with a shape as the step begins, and candidates within the step: on nodes, and of solid
/// shapes on midpoints and nearest points of edges and triangles, and below the corners of small polyhedra. Scratch
/// grows with the surface, never shrinks.
class NodeSearch
{
public:
    /// Appends to `list`. Requires that the scope's culling has tested the surface against the target's bounds.
    void find(SearchScope& scope, const InnerFaces& innerFaces, const ContactTarget& target, ContactList& list);

    void reserve(std::size_t triangles) { m_underCorners.reserve(triangles); }

private:
    void findOnNodes(SearchScope& scope, const InnerFaces& innerFaces, const ContactTarget& target, ContactList& list);
    void findOnEdges(SearchScope& scope, const InnerFaces& innerFaces, const ContactTarget& target, ContactList& list);
    void findOnTriangles(SearchScope& scope, const InnerFaces& innerFaces, const ContactTarget& target,
                         ContactList& list);
    void findOnCorners(const SearchScope& scope, const ContactTarget& target, ContactList& list);
    double considerNearest(const SearchScope& scope, const InnerFaces& innerFaces, const ContactTarget& target,
                           int feature, const Triangle& nodes, double nearest, ContactList& list);

    std::vector<int> m_underCorners;  // triangles below corners of the present target
};

}  // namespace bullet_fem

// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <vector>

#include "bullet_bridge/contact/rigid/flush_filter.h"
#include "bullet_bridge/contact/rigid/sheet_contact.h"

namespace bullet_fem
{

/// Contacts of a body's surface with sheets of two-sided triangles (sheet_contact.h). A node stays on the side that it
/// came from, which is remembered while it is near. A node without a history is on its present side; if it is less than
/// the contact band beyond a sheet, it is on the side of its body. Scratch grows with the surface and the number of
/// triangles, never shrinks.
class SheetSearch
{
public:
    /// Forgets sides and normals of the body before.
    void begin();

    /// Appends contacts as the step begins, and candidates within it; sets the target's range of sides. `heldNormal`:
    /// per vertex, the normal of its strongest contact in the last step, or 0.
    void findNear(SearchScope& scope, ContactTarget& target, const std::vector<Vec3>& heldNormal, ContactList& near);

    /// Appends the near contacts that are not flush, for vertices whose path their carriers turn those on the path, and
    /// the faces below the end of the path along a vertex's contacts.
    void findOnPaths(SearchScope& scope, const ContactTarget& target, const ContactList& near,
                     const FlushFilter& filter, ContactList& list);

    /// Sides of the nodes, target by target, for ContactMemory::m_sheetSides.
    const std::vector<SheetSide>& sides() const { return m_sides; }

private:
    /// One leaf, and the body.
    struct Sheets
    {
        const SearchScope& m_scope;
        const ContactTarget& m_target;
        double m_thickness;  // of the sheet, plus the contact offset [m]
    };
    /// A node whose path its contacts bound.
    struct BoundedNode
    {
        int m_node;
        Vec3 m_way;           // displacement relative to the object, as its carriers allow it [m]
        Vec3 m_rightSide;     // its position on the right side of the sheets [m]
        Vec3 m_lift;          // displacement that takes it off its carriers [m]
        std::size_t m_first;  // index of its first contact
    };

    bool collect(SearchScope& scope, const ContactTarget& target);
    void measureSurface(const FemSoftBody& fem);
    void findOnNodes(const Sheets& sheets, const std::vector<Vec3>& heldNormal, ContactList& list);
    void findOnTriangles(const Sheets& sheets, ContactList& list);
    void findOnEdges(const Sheets& sheets, ContactList& list);
    Vec3 safePosition(const Sheets& sheets, int node, const Vec3& position) const;
    Vec3 rightSideOf(const Sheets& sheets, int node, const Vec3& position, const Vec3& heldNormal) const;
    SheetProbe liftedProbe(const Sheets& sheets, const BoundedNode& node, const Vec3& way) const;
    void lower(const Vec3& lift);
    void considerPath(const Sheets& sheets, const BoundedNode& node, ContactList& list);
    void considerEnds(const Sheets& sheets, const BoundedNode& node, ContactList& list);
    void noteTriangle(const SheetContact& touch, ContactList& list) const;
    void considerContacts(const Sheets& sheets, int feature, const Triangle& nodes, ContactList& list);

    TriangleSoup m_soup;
    std::vector<SheetContact> m_touches;
    std::vector<SheetSide> m_sides;
    std::vector<Vec3> m_outward;      // unit normals of the nodes, weighted by angles
    std::vector<Vec3> m_edgeOutward;  // per edge, sum of the unit normals of both triangles
    bool m_measured = false;          // m_outward and m_edgeOutward are up to date
};

}  // namespace bullet_fem

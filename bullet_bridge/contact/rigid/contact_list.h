// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <vector>

#include "bullet_bridge/contact/rigid/contact_features.h"

namespace bullet_fem
{

/// Contacts of a body, in the order in which they were found, with their origins. Scratch grows with their number,
/// never shrinks.
class ContactList
{
public:
    void clear();
    void reserve(std::size_t contacts);
    std::size_t size() const { return m_points.size(); }

    std::vector<ContactPoint>& points() { return m_points; }
    const std::vector<ContactPoint>& points() const { return m_points; }
    std::vector<ContactOrigin>& origins() { return m_origins; }
    const std::vector<ContactOrigin>& origins() const { return m_origins; }
    /// Weights of a contact on its feature's corners, as keep() was given them; those that append() copied have none.
    const FeatureWeights& weights(std::size_t k) const { return m_weights[k]; }

    /// Keeps a point of a feature if it is within the band, or comes within it by the end of the step in free motion,
    /// and if the surface faces the target there.
    void consider(const SearchScope& scope, const ContactTarget& target, int feature, const Triangle& nodes,
                  const SurfaceDistance& d);

    /// Appends a contact. Returns null, and appends nothing, where the surface is anchored to the object. The pointer
    /// is valid until the next contact.
    ContactPoint* keep(const SearchScope& scope, const ContactTarget& target, int feature, const Triangle& nodes,
                       const SurfaceDistance& d);

    /// Appends contact k of another list.
    void append(const ContactList& other, std::size_t k);

private:
    std::vector<ContactPoint> m_points;
    std::vector<ContactOrigin> m_origins;
    std::vector<FeatureWeights> m_weights;
};

/// A point of a feature of the surface, and the object there.
struct PatchPoint
{
    PatchPoint(const ContactTarget& target, const Triangle& nodes, const FeatureWeights& weights, const Vec3& normal);

    const Triangle m_nodes;
    const FeatureWeights m_weights;
    const Vec3 m_normal;
    const double m_curvature;  ///< of the object where it rolls, else 0 [1/m]
};

/// Offset from a contact point that stays on the surface to the contact patch after `time` [m].
Vec3 patchOf(const SearchScope& scope, const ContactTarget& target, const PatchPoint& point, double time);

}  // namespace bullet_fem

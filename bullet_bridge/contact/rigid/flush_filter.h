// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <vector>

#include "bullet_bridge/contact/rigid/carried_motion.h"
#include "bullet_bridge/contact/rigid/contact_list.h"
#include "bullet_bridge/geometry/shapes/triangle_soup.h"
#include "bullet_bridge/geometry/tolerances.h"

namespace bullet_fem
{

constexpr double kParallelCosine = 0.999;  ///< smallest cosine of normals of one surface [-]

/// Finds the contacts with side walls that are flush with a surface that carries the point: they do not obstruct it.
/// Convex shapes beyond the contact band are judged by their paths instead. Scratch grows with the contacts, never
/// shrinks.
class FlushFilter
{
public:
    /// Judges the contacts near the surface as the step begins, and finds what carries its vertices.
    void judge(const SearchScope& scope, const std::vector<ContactTarget>& targets, const ContactList& near);

    /// True if contact k of the near ones is flush.
    bool isFlush(std::size_t k) const { return m_flush[k] != 0; }

    /// Carriers of the vertices: their present contacts that are not flush.
    const CarriedMotion& carried() const { return m_carried; }

    void reserve(std::size_t contacts);

private:
    /// A contact to be judged.
    struct Candidate
    {
        const ContactTarget& m_target;
        const ContactPoint& m_contact;
        Triangle m_corners;               // of its feature
        const FeatureWeights& m_weights;  // on these
        int m_surface;                    // number of its surface
    };

    void addCarriers(const SearchScope& scope, const std::vector<ContactTarget>& targets, const ContactList& near);
    bool isFlushWithCarriers(const SearchScope& scope, const Candidate& candidate);
    bool isBehindPath(const SearchScope& scope, const Candidate& candidate);
    bool isFlushWith(const ContactTarget& target, const ContactPoint& contact, const Vec3& onPlane, const Vec3& normal);
    bool nearestOn(const ContactTarget& target, const Vec3& point, const ContactPoint& contact, Vec3& nearest);

    std::vector<unsigned char> m_flush;  // per near contact
    CarriedMotion m_carried;
    TriangleSoup m_soup;
};

/// True if a point is beside the plane on which an object slides over soft bodies: the object sinks in, so the
/// neighbouring surface rises a little above that plane.
bool isBesideCarryingPlane(const SearchScope& scope, const ContactTarget& target, const Vec3& point, const Vec3& normal,
                           double gap);

}  // namespace bullet_fem

// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <vector>

#include "bullet_bridge/contact/rigid/contact_target.h"

namespace bullet_fem
{

/// Convex shapes side by side, of one object or immovable, are one solid: faces within their seam are none of its
/// surface. A point that has sunk in, or rolls off a rim, beside a seam is nearest to such a face, or to the rim. Its
/// distance is then that of a point before it, along the normals that held its vertices in the last step, or into the
/// body. A view of its arguments.
class InnerFaces
{
public:
    /// `heldNormal`: per vertex, the normal of its strongest contact in the last step, or 0.
    InnerFaces(const std::vector<ContactTarget>& targets, const std::vector<Vec3>& heldNormal)
        : m_targets(targets), m_heldNormal(heldNormal)
    {
    }

    /// Turns the distance of a point of a feature from a convex target, first to the face that it entered through
    /// (entered_face.h). `d`: less the contact offset, with the point's weights on the feature's corners.
    void turn(const SearchScope& scope, const ContactTarget& target, int feature, const Triangle& nodes,
              SurfaceDistance& d) const;

private:
    enum class Beside
    {
        none,
        surface,
        innerFace
    };

    Beside besideOf(const SearchScope& scope, const ContactTarget& target, const Vec3& foot, const Vec3& normal) const;
    Vec3 heldAt(const SearchScope& scope, const Triangle& nodes, const FeatureWeights& weights) const;

    const std::vector<ContactTarget>& m_targets;
    const std::vector<Vec3>& m_heldNormal;
};

}  // namespace bullet_fem

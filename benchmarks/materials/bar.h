// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <functional>
#include <vector>

#include "bullet_fem/fem/body/body.h"
#include "bullet_fem/fem/mesh/generators.h"

namespace bullet_fem
{

/// A bar along x from the origin with loaded end faces.
class Bar
{
public:
    /// Fixes the nodes with `isFixed(X)`; step [s]. Throws std::invalid_argument.
    Bar(const TetMesh& mesh, const Material& material, double step,
        const std::function<bool(const Vec3& X)>& isFixed = {});

    /// Loads both end faces with a nominal stress [Pa] along the bar's present axis.
    void pull(double stress);

    /// Loads the far end with a force [N].
    void load(const Vec3& force);

    /// Steps to static equilibrium; each step starts from rest. `renew`, if given, sets the loads before each step.
    void settle(const std::function<void()>& renew = {});

    /// Makes one dynamic step.
    void step();

    double strain() const;     ///< mean axial strain [-]
    Vec3 endPosition() const;  ///< mean over the far end [m]
    Body& body() { return m_body; }

private:
    Vec3 mean(const std::vector<double>& areas) const;

    Body m_body;
    double m_step;
    std::vector<double> m_near, m_far;  // area of the end faces per node [m2]
    double m_length = 0;
};

}  // namespace bullet_fem

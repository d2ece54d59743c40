// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <functional>
#include <vector>

#include "bullet_fem/fem/body/body.h"
#include "bullet_fem/fem/mesh/generators.h"

namespace bullet_fem
{

/// A bar along x from the origin, whose end faces are loaded.
class Bar
{
public:
    /// Nodes of which `isFixed(X)` is true do not move; step [s]. Throws std::invalid_argument.
    Bar(const TetMesh& mesh, const Material& material, double step,
        const std::function<bool(const Vec3& X)>& isFixed = {});

    /// Loads both ends with a nominal stress [Pa] along the axis that they have now.
    void pull(double stress);

    /// Loads the far end with a force [N].
    void load(const Vec3& force);

    /// To equilibrium under the loads, which `renew`, if any, sets before every step: steps that start from rest.
    void settle(const std::function<void()>& renew = {});

    /// A step of the motion.
    void step();

    double strain() const;     ///< mean along the axis [-]
    Vec3 endPosition() const;  ///< mean over the far end [m]
    Body& body() { return m_body; }

private:
    Vec3 mean(const std::vector<double>& areas) const;

    Body m_body;
    double m_step;
    std::vector<double> m_near, m_far;  // areas of the end faces a node [m2]
    double m_length = 0;
};

}  // namespace bullet_fem

// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "bullet_fem/fem/step/stress.h"

#include <cmath>

#include "fem/common/rotation.h"
#include "fem/elements/model_elements.h"

namespace bullet_fem
{

double vonMises(const Stress& s)
{
    const double xy = s.xx - s.yy, yz = s.yy - s.zz, zx = s.zz - s.xx;
    const double shear = s.xy * s.xy + s.yz * s.yz + s.xz * s.xz;
    return std::sqrt(0.5 * (xy * xy + yz * yz + zx * zx) + 3 * shear);
}

// With F = R S, sigma = R Hooke(S - I) R^T = Hooke(F R^T - I), because R turns nothing in an isotropic law. The state's
// rotations are those of the last step's start: R is found anew.
Stress elementStress(const Body& body, int e)
{
    const BodyModel& model = *body.m_model;
    const Tet& tet = model.mesh().tets()[e];
    const std::vector<Vec3>& x = body.m_state.m_x;
    const Vec3& x0 = x[tet[0]];
    const Mat3 F =
        Mat3::fromColumns(x[tet[1]] - x0, x[tet[2]] - x0, x[tet[3]] - x0) * model.shape().m_elements[e].m_DmInverse;
    const Mat3 left = timesTranspose(F, polarRotation(F, toMatrix(body.m_state.m_elementRotation[e])));

    const double mu = model.shape().m_material.lameMu();
    const double pressure = model.shape().m_material.lameLambda() * (trace(left) - 3);
    Stress s;
    s.xx = 2 * mu * (left(0, 0) - 1) + pressure;
    s.yy = 2 * mu * (left(1, 1) - 1) + pressure;
    s.zz = 2 * mu * (left(2, 2) - 1) + pressure;
    s.xy = mu * (left(0, 1) + left(1, 0));
    s.yz = mu * (left(1, 2) + left(2, 1));
    s.xz = mu * (left(0, 2) + left(2, 0));
    return s;
}

void elementStresses(const Body& body, std::vector<Stress>& perElement)
{
    perElement.resize(body.m_model->mesh().tetCount());
    for (std::size_t e = 0; e < perElement.size(); ++e) perElement[e] = elementStress(body, static_cast<int>(e));
}

void nodeStresses(const BodyModel& model, const std::vector<Stress>& perElement, std::vector<Stress>& perNode)
{
    const NodeCorners& nodes = model.elements().m_nodes;
    const std::vector<RestElement>& elements = model.shape().m_elements;
    perNode.resize(model.nodeCount());
    for (int i = 0; i < model.nodeCount(); ++i)
    {
        Stress sum;
        double volume = 0;
        for (int k = nodes.m_start[i]; k < nodes.m_start[i + 1]; ++k)
        {
            const int e = NodeCorners::element(nodes.m_corner[k]);
            Stress part = perElement[e];
            sum += part *= elements[e].m_volume;
            volume += elements[e].m_volume;
        }
        if (volume > 0) sum *= 1 / volume;
        perNode[i] = sum;
    }
}

}  // namespace bullet_fem

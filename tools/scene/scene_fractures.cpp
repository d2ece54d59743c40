// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "tools/scene/scene_fractures.h"

#include "bullet_fem/btFemVectors.h"
#include "bullet_fem/fem/mesh/tet_mesh.h"

namespace bullet_fem
{
namespace
{

int partsOf(const btSoftBody& body)
{
    std::vector<Vec3> x(body.m_nodes.size());
    std::vector<Tet> tets(body.m_tetras.size());
    for (int i = 0; i < body.m_nodes.size(); ++i) x[i] = vec3(body.m_nodes[i].m_x);
    for (int e = 0; e < body.m_tetras.size(); ++e)
        for (int a = 0; a < 4; ++a) tets[e][a] = static_cast<int>(body.m_tetras[e].m_n[a] - &body.m_nodes[0]);
    const TetMesh mesh(std::move(x), std::move(tets), LooseNodes::kept);
    return mesh.componentCount() - mesh.looseCount();
}

}  // namespace

void SceneFractures::add(btFemSoftBodySolver& fem, btSoftBody& body, const SceneFracture& from)
{
    if (!(from.m_tension > 0)) return;
    btFemTensileStrength strength;
    strength.m_tension = btScalar(from.m_tension);
    strength.m_mostCracks = from.m_mostCracks;
    strength.m_partsTouch = from.m_partsTouch;
    btFemFracture::setStrength(fem, &body, strength);
    m_bodies.push_back({&body, body.m_nodes.size(), 0, partsOf(body), {}});
}

void SceneFractures::update(btFemSoftBodySolver& fem, SceneForces& forces)
{
    const auto& splits = btFemFracture::splits(fem);
    for (int k = 0; k < splits.size(); ++k)
        for (SceneSplits& body : m_bodies)
        {
            if (body.m_body != splits[k].m_body) continue;
            ++body.m_count;
            body.m_parts = splits[k].m_parts;
            body.m_copyOf.insert(body.m_copyOf.end(), splits[k].m_copyOf.begin(), splits[k].m_copyOf.end());
            forces.follow(splits[k]);
        }
    btFemFracture::clearSplits(fem);
}

const SceneSplits* SceneFractures::find(const btSoftBody& body) const
{
    for (const SceneSplits& splits : m_bodies)
        if (splits.m_body == &body) return &splits;
    return nullptr;
}

int SceneFractures::count() const
{
    int count = 0;
    for (const SceneSplits& body : m_bodies) count += body.m_count;
    return count;
}

}  // namespace bullet_fem

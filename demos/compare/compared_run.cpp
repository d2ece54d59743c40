// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "demos/compare/compared_run.h"

#include <algorithm>
#include <cmath>
#include <ctime>

#include "bullet_fem/btFemHelpers.h"
#include "demos/common/demo.h"
#include "demos/common/demo_measures.h"
#include "demos/common/demo_surfaces.h"

namespace bullet_fem
{
namespace
{

const Vec3 kSoft{0.86, 0.52, 0.30}, kRigid{0.42, 0.55, 0.76}, kStatic{0.70, 0.71, 0.73};

/// Depth of the deepest node inside a rigid box [m].
double depthInside(const ComparedBodies& bodies)
{
    double deepest = 0;
    for (const btRigidBody* rigid : bodies.m_rigid)
    {
        const btVector3 half = static_cast<const btBoxShape*>(rigid->getCollisionShape())->getHalfExtentsWithMargin();
        for (const btSoftBody* soft : bodies.m_soft)
            for (int i = 0; i < soft->m_nodes.size(); ++i)
            {
                const btVector3 left = half - rigid->getWorldTransform().invXform(soft->m_nodes[i].m_x).absolute();
                deepest = std::max(deepest, double(std::min({left.x(), left.y(), left.z()})));
            }
    }
    return deepest;
}

/// Share of the elements of all bodies that are inverted [-].
double invertedShare(const ComparedBodies& bodies)
{
    double inverted = 0, all = 0;
    for (const btSoftBody* body : bodies.m_soft)
        for (const double volume : volumesOf(*body))
        {
            inverted += !(volume > 0);  // true for NaN, too
            ++all;
        }
    return inverted / all;
}

void keepFrame(ComparedSide& side, const ComparedBodies& bodies, DemoSurfaces& surfaces, ComparedRun& run)
{
    // Bullet's world does not update embedded surfaces.
    for (btSoftBody* body : bodies.m_soft) btFemHelpers::updateEmbeddedSurface(body);
    surfaces.update({&side.world()});
    run.m_frames.push_back(surfaces.frames());
    run.m_colours.clear();
    for (const btCollisionObject* object : surfaces.objects())
        run.m_colours.push_back(btSoftBody::upcast(object)            ? kSoft
                                : object->isStaticOrKinematicObject() ? kStatic
                                                                      : kRigid);
}

}  // namespace

double ComparedRun::medianMs() const
{
    std::vector<double> sorted = m_stepMs;
    std::sort(sorted.begin(), sorted.end());
    return sorted.at(sorted.size() / 2);
}

double ComparedRun::worstMs() const
{
    return *std::max_element(m_stepMs.begin(), m_stepMs.end());
}

ComparedRun play(const ComparedScene& scene, ComparedSide& side, double seconds)
{
    ComparedRun run;
    const ComparedBodies bodies = scene.m_build(side);
    const double start = bodies.m_top ? double(bodies.m_top->getCenterOfMassPosition().y()) : 0;
    for (const btSoftBody* body : bodies.m_soft) run.m_elements += body->m_tetras.size();
    DemoSurfaces surfaces;
    keepFrame(side, bodies, surfaces, run);
    const int steps = std::max(1, static_cast<int>(std::lround(seconds / kDemoStep)));
    for (int k = 1; k <= steps; ++k)
    {
        const std::clock_t before = std::clock();
        side.world().stepSimulation(btScalar(kDemoStep), 0);  // 0: one step of exactly this size
        run.m_stepMs.push_back(1e3 * double(std::clock() - before) / CLOCKS_PER_SEC);
        for (const btSoftBody* body : bodies.m_soft)
            run.m_deepest = std::max(run.m_deepest, -double(lowestOf(*body).y()));
        run.m_inside = std::max(run.m_inside, depthInside(bodies));
        run.m_inverted = std::max(run.m_inverted, invertedShare(bodies));
        if (k % kStepsPerFrame == 0) keepFrame(side, bodies, surfaces, run);
    }
    if (bodies.m_top) run.m_height = double(bodies.m_top->getCenterOfMassPosition().y()) / start;
    for (const btRigidBody* body : bodies.m_rigid)
        run.m_fastest = std::max(run.m_fastest, double(body->getLinearVelocity().length()));
    return run;
}

}  // namespace bullet_fem

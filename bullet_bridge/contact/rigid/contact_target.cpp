// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "bullet_bridge/contact/rigid/contact_target.h"

#include <algorithm>

#include "BulletCollision/BroadphaseCollision/btBroadphaseInterface.h"
#include "BulletCollision/CollisionDispatch/btCollisionObject.h"
#include "BulletCollision/CollisionShapes/btCollisionShape.h"
#include "BulletSoftBody/btSoftBody.h"
#include "bullet_bridge/contact/friction.h"
#include "bullet_bridge/geometry/shapes/field_distance.h"
#include "bullet_bridge/geometry/tolerances.h"

namespace bullet_fem
{
namespace
{

constexpr double kAdvantage = 0.003;  // by which a nearest point must be closer than the fixed points, over the mean
                                      // edge [-]
constexpr double kRigidStiffness = 1e17;       // Bullet's value for a rigid contact is 1e18 (float) or 1e30 [N/m]
constexpr double kUsualKineticHardness = 0.1;  // Bullet's default of kKHR; those of kCHR and kSHR are 1

// Upper bound on the speed of an object's points near the body [m/s]: linear velocity plus spin times the leaf's size.
double fastestPoint(const RigidProxy& rigidProxy, const ShapeLeaf& shape)
{
    const double spin = norm(rigidProxy.m_angularVelocity);
    const double size = spin > 0 ? norm(shape.m_boundsMax - shape.m_boundsMin) : 0;  // a plane's would be infinite
    return norm(rigidProxy.m_linearVelocity) + spin * size;
}

// Speed that gravity adds in a step [m/s]. It does not count as motion: resting bodies have it as well.
double fallingSpeed(const FemSoftBody& fem, double step)
{
    return step * norm(fem.gravity());
}

// Contact parameters from both sides, as Bullet combines them, with the soft body's friction coefficient. NaN counts as
// 0.
SurfacePair surfacePairOf(const btSoftBody& soft, const btCollisionObject& object)
{
    const auto atLeastZero = [](double value) { return value > 0 ? value : 0; };
    SurfacePair surface;
    surface.m_hardness = atLeastZero(object.isStaticOrKinematicObject() ? soft.m_cfg.kKHR / kUsualKineticHardness
                                                                        : double(soft.m_cfg.kCHR));
    surface.m_friction = frictionBetween(soft, object);
    surface.m_restitution = std::min(1.0, atLeastZero(double(soft.getRestitution()) * object.getRestitution()));
    if (!(object.getCollisionFlags() & btCollisionObject::CF_HAS_CONTACT_STIFFNESS_DAMPING)) return surface;
    if (!(object.getContactStiffness() < kRigidStiffness)) return surface;
    surface.m_stiffness = atLeastZero(object.getContactStiffness());
    surface.m_damping = atLeastZero(object.getContactDamping());
    return surface;
}

const SolidPlace* lastPlaceOf(const FemSoftBody& fem, const ContactTarget& target)
{
    const std::vector<SolidPlace>& solids = fem.m_memory.m_solids;
    const SolidPlace key = {broadphaseId(*target.m_object), target.m_leaf, {}};
    const auto place = std::lower_bound(solids.begin(), solids.end(), key);
    const bool isKnown = place != solids.end() && !(key < *place);
    return isKnown && isMovableSolid(target) && fem.m_memory.m_positions.size() == fem.surfacePosition().size()
               ? &*place
               : nullptr;
}

// Displacement by gravity within the step, 0 for objects that cannot move or fall little.
Vec3 fallOf(const FemSoftBody& fem, const ContactTarget& target)
{
    const Vec3 gravity = fem.gravity();
    if (!target.m_motion->canMove() || !isFinite(gravity)) return {};
    const double edge = fem.m_body.m_model->mesh().meanEdgeLength();  // as in RigidProxies
    return fallsFar(sweptShapeOf(target), norm(gravity), edge) ? target.m_step * target.m_step * gravity : Vec3();
}

}  // namespace

btBroadphaseInterface* broadphaseOf(const FemSoftBody& fem)
{
    const btSoftBodyWorldInfo* world = fem.m_softBody->m_worldInfo;
    btBroadphaseInterface* broadphase = world ? world->m_broadphase : nullptr;
    return broadphase && broadphase->getOverlappingPairCache() ? broadphase : nullptr;
}

bool isMovableSolid(const ContactTarget& target)
{
    return target.m_motion->canMove() && isSolid(*target.m_shape->m_shape);
}

void SearchScope::begin(FemSoftBody& fem, int bodyIndex)
{
    m_fem = &fem;
    m_bodyIndex = bodyIndex;
    m_edge = fem.m_surface.meanEdge();
    m_band = kContactBand * m_edge;
    m_advantage = kAdvantage * m_edge;
    m_size = fem.m_surface.size();
    m_exposed.clear();
}

void SearchScope::findExposed()
{
    m_exposed.clear();
    FemSoftBody& body = fem();
    const std::vector<int>& inner = body.innerNodes();
    if (inner.empty()) return;
    const std::vector<Vec3>& x = body.surfacePosition();
    m_isInsideOut.clear();
    if (body.m_search.m_isInsideOut)
    {
        m_isInsideOut.assign(x.size(), 0);
        for (const Tet& t : body.m_body.m_model->mesh().tets())
            if (dot(cross(x[t[1]] - x[t[0]], x[t[2]] - x[t[0]]), x[t[3]] - x[t[0]]) < 0)
                for (int node : t) m_isInsideOut[node] = 1;
    }
    const Vec3 low = m_culling.low(), high = m_culling.high();
    for (int i : inner)
    {
        bool isOutside = !m_isInsideOut.empty() && m_isInsideOut[i] != 0;
        for (int c = 0; c < 3; ++c) isOutside = isOutside || x[i][c] < low[c] || x[i][c] > high[c];
        if (isOutside) m_exposed.push_back(i);
    }
    if (m_exposed.empty()) return;
    body.serveInnerNodes();
    for (int i : m_exposed) m_culling.include(x[i]);
    m_middle = Vec3();
    for (int i : surfaceVertices()) m_middle += (1.0 / static_cast<double>(surfaceVertices().size())) * x[i];
    m_exposed.insert(m_exposed.end(), surfaceVertices().begin(), surfaceVertices().end());
    std::sort(m_exposed.begin(), m_exposed.end());
}

// Bullet has moved kinematic objects already, while their leaves are at the start of the step: moves the proxy back.
// Rolling objects have been moved on with their leaves: the rest of their motion remains.
const RigidProxy& ContactTargets::asTheStepBegan(const ContactObject& touched, const RigidSurroundings& around)
{
    const RigidProxy& rigidProxy = around.m_rigidProxies[touched.m_rigidProxy];
    const bool isKinematic = touched.m_object->isKinematicObject();
    if (!isKinematic && dot(touched.m_advance, touched.m_advance) == 0) return rigidProxy;
    m_starts.push_back(rigidProxy);
    RigidProxy& start = m_starts.back();
    if (isKinematic)
        start.m_center -= around.m_step * rigidProxy.m_linearVelocity;
    else
    {
        start.m_center += touched.m_advance;
        start.m_linearVelocity -= (1 / around.m_step) * touched.m_advance;
    }
    return start;
}

void ContactTargets::list(SearchScope& scope, const RigidSurroundings& around)
{
    FemSoftBody& fem = scope.fem();
    m_targets.clear();
    m_starts.clear();
    m_starts.reserve(around.m_count);  // m_targets points into it
    if (around.m_count == 0) return;
    fem.updateSkin();
    scope.m_culling.begin(fem.m_surface, fem.surfacePosition());
    scope.findExposed();
    scope.m_fastest = fastestNode(fem.m_body, Vec3());
    const double softReach = scope.m_band + fem.m_settings.m_contactOffset +
                             around.m_step * (fem.m_skin ? fastestVertex(fem, Vec3()) : scope.m_fastest);
    for (int k = 0; k < around.m_count; ++k)
    {
        const ContactObject& touched = around.m_touched[k];
        const RigidProxy& rigidProxy = asTheStepBegan(touched, around);
        const SurfacePair surface = surfacePairOf(*fem.m_softBody, *touched.m_object);
        for (int l = 0; l < touched.m_leafCount; ++l)
        {
            const ShapeLeaf& shape = around.m_leaves[touched.m_firstLeaf + l];
            m_targets.push_back({&shape, touched.m_object, l, touched.m_rigidProxy, &rigidProxy,
                                 around.m_rigidProxies[touched.m_rigidProxy].m_center - rigidProxy.m_center, surface,
                                 softReach + around.m_step * fastestPoint(rigidProxy, shape), Vec3(), around.m_step,
                                 &touched.m_carrying, touched.m_advance, touched.m_mayBeStopped, nullptr,
                                 TargetKind::slow, 0, 0, 0, 0});
            ContactTarget& target = m_targets.back();
            target.m_last = lastPlaceOf(fem, target);
            target.m_fall = fallOf(fem, target);
            target.m_reach += norm(target.m_fall);
        }
    }
}

SweptShape sweptShapeOf(const ContactTarget& target)
{
    const RigidProxy& motion = *target.m_motion;
    return SweptShape(*target.m_shape, {motion.m_center, motion.m_linearVelocity, motion.m_angularVelocity},
                      target.m_step);
}

bool isFastTarget(const SearchScope& scope, const ContactTarget& target)
{
    const FemSoftBody& fem = scope.fem();
    const SweptShape swept = sweptShapeOf(target);
    const double edge = fem.m_body.m_model->mesh().meanEdgeLength();  // as in RigidProxies
    const double falling = 2 * fallingSpeed(fem, target.m_step);
    // cheap upper bound first
    return isFast(swept, scope.m_fastest + norm(swept.m_motion.m_linearVelocity) - falling, edge) &&
           isFast(swept, fastestNode(fem.m_body, swept.m_motion.m_linearVelocity) - falling, edge);
}

bool mayHaveGone(const SearchScope& scope, const ContactTarget& target, const Vec3& way)
{
    return norm(way) < 4 * target.m_reach + scope.m_edge;
}

bool isEnclosed(const SearchScope& scope, const ContactTarget& target)
{
    const FemSoftBody& fem = scope.fem();
    if (fem.m_skin || !isSolid(*target.m_shape->m_shape)) return false;
    const Vec3 middle = 0.5 * (target.m_shape->m_boundsMin + target.m_shape->m_boundsMax);
    const Vec3 low = scope.m_culling.low(), high = scope.m_culling.high();
    for (int c = 0; c < 3; ++c)
        if (!(middle[c] > low[c] && middle[c] < high[c])) return false;
    const std::vector<Vec3>& x = fem.m_body.m_state.m_x;
    const auto volume = [](const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d)
    { return dot(cross(b - a, c - a), d - a); };
    const std::vector<Tet>& tets = fem.m_body.m_model->mesh().tets();
    return std::any_of(tets.begin(), tets.end(),
                       [&](const Tet& t)
                       {
                           const Vec3 &a = x[t[0]], &b = x[t[1]], &c = x[t[2]], &d = x[t[3]];
                           return volume(middle, b, c, d) > 0 && volume(a, middle, c, d) > 0 &&
                                  volume(a, b, middle, d) > 0 && volume(a, b, c, middle) > 0;
                       });
}

}  // namespace bullet_fem

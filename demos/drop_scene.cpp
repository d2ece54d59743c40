// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "demos/drop_scene.h"

#include "BulletSoftBody/btSoftBody.h"
#include "bullet_fem/btFemHelpers.h"
#include "bullet_fem/io/surface_file.h"

namespace bullet_fem
{
namespace
{

constexpr int kWantedTets = 5000;
const btVector3 kGravity(0, btScalar(-9.81), 0);  // [m/s2]

// The friction of a contact between soft and rigid body is the product of both: 0.2 on the ramp, where the body slides
// (tan 20 deg = 0.36), and 0.5 on the plane, where it stops.
constexpr btScalar kSoftFriction = btScalar(0.5), kRampFriction = btScalar(0.4), kPlaneFriction = 1,
                   kBoxFriction = btScalar(0.6);

// In units of the body's length.
constexpr btScalar kRampTilt = btScalar(20) * SIMD_RADS_PER_DEG;
const btVector3 kRampHalfExtents(btScalar(0.75), btScalar(0.06), btScalar(0.75));
// The body's centre: above the upper half of the ramp, whose centre is at 0.
constexpr btScalar kStartX = btScalar(-0.25);
constexpr btScalar kStartGap = btScalar(0.2);  // between ramp and body

struct FallingBox
{
    btVector3 m_halfExtents;  // in units of the body's length
    btVector3 m_position;     // x and z from the body's centre, y from its top, in units of the body's length
    double m_density;         // [kg/m3]
};

// The boxes reach the body one after another, farther along its path.
const FallingBox kFallingBoxes[] = {
    {btVector3(btScalar(.18), btScalar(.07), btScalar(.18)), btVector3(btScalar(.28), btScalar(.4), btScalar(.12)),
     500},
    {btVector3(btScalar(.11), btScalar(.11), btScalar(.11)), btVector3(btScalar(.50), btScalar(1.), btScalar(.22)),
     500},
    {btVector3(btScalar(.16), btScalar(.10), btScalar(.12)), btVector3(btScalar(.78), btScalar(1.9), btScalar(.30)),
     500},
};

btTransform rampPose(btScalar length)
{
    // The lower edge of the ramp rests on the plane.
    const btScalar height = kRampHalfExtents.x() * btSin(kRampTilt) + kRampHalfExtents.y() * btCos(kRampTilt);
    return btTransform(btQuaternion(btVector3(0, 0, 1), -kRampTilt), btVector3(0, height, 0) * length);
}

// Height of the ramp's upper face above the plane at x.
btScalar rampHeight(btScalar x, btScalar length)
{
    const btTransform pose = rampPose(length);
    const btVector3 normal = pose.getBasis().getColumn(1);
    const btVector3 onFace = pose.getOrigin() + normal * (kRampHalfExtents.y() * length);
    return onFace.y() - (x - onFace.x()) * normal.x() / normal.y();
}

// Bounds of the nodes: btSoftBody::getAabb adds a margin that does not scale with the scene.
void boundsOf(const btSoftBody& body, btVector3& low, btVector3& high)
{
    low = high = body.m_nodes[0].m_x;
    for (int i = 1; i < body.m_nodes.size(); ++i)
    {
        low.setMin(body.m_nodes[i].m_x);
        high.setMax(body.m_nodes[i].m_x);
    }
}

// Moves the body's centre to x = kStartX, and down to a gap of kStartGap.
void placeAboveRamp(btSoftBody& body, btScalar length)
{
    btVector3 low, high;
    boundsOf(body, low, high);
    btVector3 shift = (low + high) / -2;
    shift.setX(shift.x() + kStartX * length);
    btScalar rise = -SIMD_INFINITY;
    for (int i = 0; i < body.m_nodes.size(); ++i)
    {
        const btVector3& x = body.m_nodes[i].m_x;
        rise = btMax(rise, rampHeight(x.x() + shift.x(), length) - x.y());
    }
    shift.setY(rise + kStartGap * length);
    body.translate(shift);
}

}  // namespace

DropScene::DropScene(const DropOptions& options, const DropSize& size) : m_length(size.m_length), m_step(options.m_step)
{
    m_world.setGravity(kGravity);
    m_world.getWorldInfo().m_gravity = kGravity;
    addPlane();
    addRamp();
    addSoftBody(options, size);
    addFallingBoxes();
}

DropScene::~DropScene()
{
    if (m_softBody) m_world.removeSoftBody(m_softBody.get());
    for (const auto& box : m_boxes) m_world.removeRigidBody(box.get());
    if (m_plane) m_world.removeRigidBody(m_plane.get());
}

void DropScene::step()
{
    m_world.stepSimulation(static_cast<btScalar>(m_step), 0);  // 0: one step of exactly this size
}

void DropScene::addPlane()
{
    m_configuration.setPlaneConvexMultipointIterations();  // otherwise boxes get one contact point and penetrate
    m_shapes.push_back(std::make_unique<btStaticPlaneShape>(btVector3(0, 1, 0), btScalar(0)));
    m_plane = std::make_unique<btRigidBody>(btScalar(0), nullptr, m_shapes.back().get());
    m_plane->setFriction(kPlaneFriction);
    m_world.addRigidBody(m_plane.get());
}

void DropScene::addRamp()
{
    const btScalar length = static_cast<btScalar>(m_length);
    addBox(kRampHalfExtents * length, rampPose(length), 0)->setFriction(kRampFriction);
}

void DropScene::addSoftBody(const DropOptions& options, const DropSize& size)
{
    btFemMaterial material;
    material.m_youngModulus = static_cast<btScalar>(options.m_youngModulus);
    material.m_poissonRatio = static_cast<btScalar>(options.m_poissonRatio);
    material.m_density = static_cast<btScalar>(options.m_density);

    CageSettings cage;
    cage.m_cellSize = options.m_cellSize;
    cage.m_targetTets = options.m_cellSize > 0 ? 0 : kWantedTets;
    m_softBody.reset(btFemHelpers::createFromSurface(m_world.getWorldInfo(),
                                                     readSurfaceFile(options.m_meshFile, size.m_scale), cage, m_cage));
    m_softBody->m_cfg.kDF = kSoftFriction;
    m_fem.setMaterial(m_softBody.get(), material);

    placeAboveRamp(*m_softBody, static_cast<btScalar>(m_length));
    btFemHelpers::updateEmbeddedSurface(m_softBody.get());

    m_fem.prepare(m_softBody.get(), static_cast<btScalar>(m_step));
    m_world.addSoftBody(m_softBody.get());
}

void DropScene::addFallingBoxes()
{
    btVector3 low, high;
    boundsOf(*m_softBody, low, high);
    const btScalar length = static_cast<btScalar>(m_length);
    const btVector3 top((low.x() + high.x()) / 2, high.y(), (low.z() + high.z()) / 2);
    for (const FallingBox& box : kFallingBoxes)
        addBox(box.m_halfExtents * length, btTransform(btQuaternion::getIdentity(), top + box.m_position * length),
               box.m_density);
}

btRigidBody* DropScene::addBox(const btVector3& halfExtents, const btTransform& pose, double density)
{
    auto shape = std::make_unique<btBoxShape>(halfExtents);
    const btVector3 size = halfExtents * 2;
    const btScalar mass = static_cast<btScalar>(density) * size.x() * size.y() * size.z();
    btVector3 inertia(0, 0, 0);
    if (mass > 0) shape->calculateLocalInertia(mass, inertia);
    auto body = std::make_unique<btRigidBody>(mass, nullptr, shape.get(), inertia);
    body->setWorldTransform(pose);
    body->setInterpolationWorldTransform(pose);
    body->setFriction(kBoxFriction);
    m_world.addRigidBody(body.get());
    m_shapes.push_back(std::move(shape));
    m_boxes.push_back(std::move(body));
    return m_boxes.back().get();
}

}  // namespace bullet_fem

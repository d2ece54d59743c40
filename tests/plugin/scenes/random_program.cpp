// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "plugin/scenes/random_program.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <stdexcept>
#include <string>

#include "bullet_fem/btFemHelpers.h"
#include "bullet_fem/btFemVectors.h"
#include "bullet_fem/fem/mesh/generators.h"
#include "plugin/scenes/bullet_state.h"
#include "plugin/scenes/scene_measures.h"

namespace bullet_fem
{
namespace
{

constexpr int kMaxSoft = 5, kMaxRigid = 8;
// A large rotation in a long step stretches the body, which springs back in a much shorter step (docs/reliability.md).
constexpr double kShorterSteps = 4;  // maximum ratio of a gentle program's consecutive steps
constexpr double kThrown = 10;       // [m/s], [rad/s]: initial speed in a gentle program

void addTo(std::vector<btScalar>& all, const std::vector<btScalar>& more)
{
    all.insert(all.end(), more.begin(), more.end());
}

btFemSolverInfo infoOf(std::mt19937& generator)
{
    btFemSolverInfo info;
    info.m_threads = 1 + static_cast<int>(generator() % 2);
    info.m_manifolds = generator() % 2 == 0;
    info.m_maxContacts = generator() % 4 == 0 ? 8 : 2000;
    info.m_contactTolerance = generator() % 2 == 0 ? btScalar(3e-5) : btScalar(1e-2);
    info.m_factorChoice = generator() % 4 == 0 ? btFemFactorChoice::lowMemory : btFemFactorChoice::full;
    info.m_refactoring = generator() % 2 == 0 ? btFemRefactoring::synchronous : btFemRefactoring::onRequest;
    return info;
}

}  // namespace

RandomProgram::RandomProgram(WorldClass worldClass, Coupling coupling, unsigned number, Manner manner)
    : m_number(number),
      m_manner(manner),
      m_generator(number),
      m_world(worldClass, coupling, btVector3(0, 0, btScalar(-kGravity)), infoOf(m_generator)),
      m_fem(m_world.fem())
{
    m_world.addPlane();
}

const std::vector<RandomProgram::Act>& RandomProgram::acts()
{
    using P = RandomProgram;
    static const std::vector<Act> all = {{"step", 60, 60, &P::step},
                                         {"addBox", 4, 4, &P::addBox},
                                         {"addBall", 2, 3, &P::addBall},
                                         {"addTets", 2, 0, &P::addTets},
                                         {"removeSoft", 2, 1, &P::removeSoft},
                                         {"readd", 2, 1, &P::readd},
                                         {"addRigid", 4, 4, &P::addRigid},
                                         {"addStatic", 2, 1, &P::addStatic},
                                         {"removeRigid", 2, 1, &P::removeRigid},
                                         {"throwRigid", 4, 2, &P::throwRigid},
                                         {"setMaterial", 4, 3, &P::setMaterial},
                                         {"setDetail", 2, 1, &P::setDetail},
                                         {"setFlags", 2, 0, &P::setFlags},
                                         {"setConfig", 2, 0, &P::setConfig},
                                         {"writeNodes", 3, 0, &P::writeNodes},
                                         {"writeBadNodes", 2, 0, &P::writeBadNodes},
                                         {"pin", 3, 1, &P::pin},
                                         {"setMasses", 2, 0, &P::setMasses},
                                         {"setTargets", 3, 0, &P::setTargets},
                                         {"clearTargets", 2, 0, &P::clearTargets},
                                         {"anchor", 3, 2, &P::anchor},
                                         {"attach", 3, 0, &P::attach},
                                         {"detach", 2, 0, &P::detach},
                                         {"spring", 3, 0, &P::spring},
                                         {"move", 3, 0, &P::move},
                                         {"scale", 2, 0, &P::scale},
                                         {"remember", 1, 0, &P::remember},
                                         {"append", 1, 0, &P::append},
                                         {"removeTets", 1, 0, &P::removeTets},
                                         {"prepare", 2, 1, &P::prepare},
                                         {"refactor", 2, 2, &P::refactor},
                                         {"save", 3, 0, &P::save},
                                         {"restore", 3, 0, &P::restore},
                                         {"define", 1, 0, &P::define},
                                         {"redefine", 1, 0, &P::redefine},
                                         {"query", 6, 3, &P::query},
                                         {"setGravity", 1, 0, &P::setGravity},
                                         {"makeClusters", 1, 0, &P::makeClusters},
                                         {"setPose", 1, 0, &P::setPose},
                                         {"setActivation", 2, 1, &P::setActivation},
                                         {"replay", 0, 3, &P::replay}};
    return all;
}

void RandomProgram::act(unsigned number)
{
    std::seed_seq seeds{m_number, number};
    m_generator.seed(seeds);
    int sum = 0;
    for (const Act& a : acts()) sum += weight(a);
    int left = below(sum);
    const Act* chosen = &acts().front();
    for (const Act& a : acts())
    {
        if (left < weight(a))
        {
            chosen = &a;
            break;
        }
        left -= weight(a);
    }
    m_last = chosen->m_name;
    try
    {
        (this->*chosen->m_do)();
    }
    catch (const std::invalid_argument&)
    {
        ++m_refusals;
    }
    catch (const std::runtime_error&)  // rounding makes the matrix indefinite
    {
        if (m_last != std::string("refactor") && m_last != std::string("prepare")) throw;
        ++m_refusals;
    }
}

double RandomProgram::number(double from, double to)
{
    return from + (to - from) * (m_generator() / 4294967296.0);
}

double RandomProgram::logarithmic(double from, double to)
{
    return std::exp(number(std::log(from), std::log(to)));
}

int RandomProgram::below(int count)
{
    return static_cast<int>(m_generator() % static_cast<unsigned>(count));
}

btVector3 RandomProgram::vector(double size)
{
    const double x = number(-size, size), y = number(-size, size), z = number(-size, size);
    return btVector3(btScalar(x), btScalar(y), btScalar(z));
}

btVector3 RandomProgram::place()
{
    if (m_manner == Manner::gentle) return vector(1) + btVector3(0, 0, btScalar(number(1.5, 4)));
    return vector(0.6) + btVector3(0, 0, btScalar(0.8));
}

btTransform RandomProgram::pose(double size)
{
    const btVector3 axis = vector(1) + btVector3(0, 0, 2);
    return btTransform(btQuaternion(axis.normalized(), btScalar(number(-3, 3))), vector(size));
}

btSoftBody* RandomProgram::anySoft()
{
    if (m_soft.empty()) throw std::invalid_argument("no soft body");
    return m_soft[below(static_cast<int>(m_soft.size()))];
}

btRigidBody* RandomProgram::anyRigid()
{
    if (m_rigid.empty()) throw std::invalid_argument("no rigid body");
    return m_rigid[below(static_cast<int>(m_rigid.size()))];
}

int RandomProgram::nodeOf(const btSoftBody& body)
{
    return one(20) ? body.m_nodes.size() : below(body.m_nodes.size());
}

btSoftBody::Node& RandomProgram::anyNode(btSoftBody& body)
{
    return body.m_nodes[below(body.m_nodes.size())];
}

btScalar RandomProgram::badNumber()
{
    constexpr btScalar infinity = std::numeric_limits<btScalar>::infinity();
    const btScalar values[] = {std::numeric_limits<btScalar>::quiet_NaN(), infinity, -infinity, btScalar(1e30),
                               btScalar(-1e12)};
    return values[below(5)];
}

void RandomProgram::step()
{
    const bool gentle = m_manner == Manner::gentle;
    double h = one(4) ? logarithmic(1e-3, gentle ? 0.05 : 0.1) : 1.0 / 60;
    if (gentle) h = std::max(h, m_step / kShorterSteps);
    m_step = h;
    if (one(5)) m_world.bullet().stepSimulation(btScalar(number(0, 0.06)), 4, btScalar(h));
    removeRejected();
    for (int left = 1 + below(4); left > 0; --left)
    {
        stepWorld(1, h);
        removeRejected();
    }
}

void RandomProgram::stepWorld(int count, double h)
{
    m_world.step(count, btScalar(h));
    m_steps += count;
}

// From the step that rejects a body on Bullet moves it, with all written values, and its anchors.
void RandomProgram::removeRejected()
{
    const std::vector<btSoftBody*> all = m_soft;
    for (btSoftBody* body : all)
    {
        if (!(m_fem.stepReport(body).m_flags & BT_FEM_REJECTED)) continue;
        removeLost(*body);
        remove(body);
    }
}

// Bullet's anchors of a distant body overflow single precision.
void RandomProgram::removeLost(const btSoftBody& rejected)
{
    std::vector<btRigidBody*> lost;
    for (btRigidBody* body : m_rigid)
    {
        if (isFinite(vec3(body->getWorldTransform().getOrigin())) && isFinite(vec3(body->getLinearVelocity())))
            continue;
        for (int k = 0; k < rejected.m_anchors.size(); ++k)
            if (rejected.m_anchors[k].m_body == body)
            {
                lost.push_back(body);
                break;
            }
    }
    for (btRigidBody* body : lost) remove(body);
}

void RandomProgram::addSoft(btSoftBody* body)
{
    body->translate(place());
    m_world.addSoft(body);
    if (one(2)) body->forceActivationState(ACTIVE_TAG);
    body->m_cfg.kDF = btScalar(number(0, 1));
    m_soft.push_back(body);
    if (static_cast<int>(m_soft.size()) > kMaxSoft) removeSoft();
}

void RandomProgram::addBox()
{
    const btVector3 half(btScalar(logarithmic(0.02, 0.4)), btScalar(logarithmic(0.02, 0.4)),
                         btScalar(logarithmic(0.02, 0.4)));
    addSoft(btFemHelpers::createBox(m_world.info(), btVector3(0, 0, 0), half, btScalar(half.length() / number(1, 3))));
}

void RandomProgram::addBall()
{
    btSoftBody* body = btFemHelpers::createFromTetMesh(m_world.info(), makeSphere(logarithmic(0.05, 0.4), 4));
    addSoft(body);
}

// At least one, of poor shape.
void RandomProgram::addTets()
{
    auto* body = new btSoftBody(&m_world.info());
    body->appendMaterial();
    const int count = 4 + below(4);
    for (int i = 0; i < count; ++i) body->appendNode(vector(0.3), 1);
    for (int t = 0; t + 3 < count; ++t) body->appendTetra(t, t + 1, t + 2, t + 3);
    if (one(2)) body->initializeDmInverse();
    addSoft(body);
}

void RandomProgram::removeSoft()
{
    remove(anySoft());
}

void RandomProgram::remove(btSoftBody* body)
{
    forgetJoints();
    m_soft.erase(std::find(m_soft.begin(), m_soft.end(), body));
    m_world.deleteSoft(*body);
}

// Bullet's joints store addresses.
void RandomProgram::forgetJoints()
{
    for (btSoftBody* body : m_soft)
    {
        for (int k = 0; k < body->m_joints.size(); ++k) btAlignedFree(body->m_joints[k]);
        body->m_joints.clear();
    }
}

void RandomProgram::readd()
{
    btSoftBody* body = anySoft();
    m_world.take(*body);
    const bool away = one(2);  // absent during a step
    if (away) stepWorld(1, 1.0 / 60);
    m_world.put(*body);
    if (!away) return;
    stepWorld(1, 1.0 / 60);  // restores written values
    removeRejected();
}

void RandomProgram::addRigid()
{
    const btScalar r = btScalar(logarithmic(0.03, 0.3)), s = btScalar(logarithmic(0.03, 0.3));
    btCollisionShape* shape = nullptr;
    switch (below(6))
    {
        case 0:
            shape = new btSphereShape(r);
            break;
        case 1:
            shape = new btCapsuleShape(r, s);
            break;
        case 2:
            shape = new btCylinderShapeZ(btVector3(r, r, s));
            break;
        case 3:
            shape = new btConeShape(r, s);
            break;
        case 4:
        {
            auto* compound = new btCompoundShape;
            compound->addChildShape(pose(0.1), m_world.keep(new btBoxShape(btVector3(r, s, r))));
            compound->addChildShape(pose(0.1), m_world.keep(new btSphereShape(s)));
            shape = compound;
            break;
        }
        default:
            shape = new btBoxShape(btVector3(r, s, r));
            break;
    }
    RigidSettings settings;
    settings.m_mass = btScalar(logarithmic(0.01, 100));
    settings.m_transform = pose(0.2);
    settings.m_transform.setOrigin(place());
    settings.m_friction = btScalar(number(0, 2));
    settings.m_velocity = vector(3);
    if (m_manner == Manner::gentle) settings.m_mass = btScalar(number(0.1, 10));
    m_rigid.push_back(&m_world.addRigid(shape, settings));
    if (one(2)) m_rigid.back()->forceActivationState(ACTIVE_TAG);
    if (static_cast<int>(m_rigid.size()) > kMaxRigid) removeRigid();
}

void RandomProgram::addStatic()
{
    RigidSettings settings;
    settings.m_transform = pose(0.2);
    settings.m_transform.setOrigin(place());
    btRigidBody& body =
        m_world.addRigid(new btBoxShape(btVector3(btScalar(0.3), btScalar(0.1), btScalar(0.2))), settings);
    if (one(2)) body.setCollisionFlags(body.getCollisionFlags() | btCollisionObject::CF_KINEMATIC_OBJECT);
    m_rigid.push_back(&body);
    if (static_cast<int>(m_rigid.size()) > kMaxRigid) removeRigid();
}

void RandomProgram::removeRigid()
{
    remove(anyRigid());
}

void RandomProgram::remove(btRigidBody* body)
{
    m_rigid.erase(std::find(m_rigid.begin(), m_rigid.end(), body));
    for (btSoftBody* soft : m_soft)  // Bullet's anchors store addresses
        for (int k = soft->m_anchors.size() - 1; k >= 0; --k)
            if (soft->m_anchors[k].m_body == body)
            {
                soft->m_anchors.swap(k, soft->m_anchors.size() - 1);
                soft->m_anchors.pop_back();
            }
    m_world.deleteRigid(*body);
}

void RandomProgram::throwRigid()
{
    btRigidBody* body = anyRigid();
    const bool gentle = m_manner == Manner::gentle;
    const double fast = gentle ? kThrown : 300;
    const btVector3 velocity = vector(logarithmic(0.1, fast)), spin = vector(logarithmic(0.1, fast));
    // A static body stays, and pushes bodies in contact forever.
    const bool stays = gentle && body->isStaticObject();
    body->setLinearVelocity(stays ? btVector3(0, 0, 0) : velocity);
    body->setAngularVelocity(stays ? btVector3(0, 0, 0) : spin);
    if (bad(4)) body->setWorldTransform(btTransform(btQuaternion::getIdentity(), place()));
    body->activate(true);
}

void RandomProgram::setMaterial()
{
    btFemMaterial material;
    const bool gentle = m_manner == Manner::gentle;
    material.m_youngModulus = bad(20) ? badNumber() : btScalar(logarithmic(gentle ? 3e4 : 1e2, 1e9));
    material.m_poissonRatio = btScalar(number(0, bad(10) ? 0.6 : 0.49));
    material.m_density = one(4) ? 0 : btScalar(logarithmic(gentle ? 50 : 1, gentle ? 5e3 : 2e4));
    material.m_stiffnessDamping = btScalar(logarithmic(1e-5, 1e-1));
    btSoftBody* body = anySoft();
    // A stiffer material gives a crushed body energy (docs/reliability.md).
    const bool isCrushed = m_fem.stepReport(body).m_flags & (BT_FEM_INSIDE_OUT | BT_FEM_PENETRATING);
    if (!gentle || !isCrushed) m_fem.setMaterial(body, material);
}

void RandomProgram::setDetail()
{
    m_fem.setDetail(anySoft(), static_cast<btFemDetail>(below(5)));
    m_fem.setContactOffset(anySoft(), btScalar(one(2) ? 0 : number(m_manner == Manner::gentle ? 0 : -0.01, 0.05)));
}

void RandomProgram::setFlags()
{
    btSoftBody* body = anySoft();
    body->m_cfg.collisions = btSoftBody::fCollision::SDF_RS;
    if (one(2)) body->m_cfg.collisions |= btSoftBody::fCollision::VF_SS;
    if (one(3)) body->m_cfg.collisions |= btSoftBody::fCollision::CL_SELF;
    if (one(4)) body->m_cfg.collisions |= BT_FEM_RENDER_SURFACE;
}

void RandomProgram::setConfig()
{
    btSoftBody* body = anySoft();
    btScalar* const values[] = {&body->m_cfg.kDF, &body->m_cfg.kDP, &body->m_cfg.kDG, &body->m_cfg.kLF,
                                &body->m_cfg.kPR, &body->m_cfg.kVC, &body->m_cfg.kMT, &body->m_cfg.kSHR};
    *values[below(8)] = one(10) ? badNumber() : btScalar(number(0, 1));
}

void RandomProgram::writeNodes()
{
    btSoftBody& body = *anySoft();
    for (int k = 0; k < 3; ++k)
    {
        btSoftBody::Node& node = anyNode(body);
        if (one(2)) node.m_x += vector(0.1);
        if (one(2)) node.m_v += vector(logarithmic(0.1, 100));
        if (one(2)) node.m_f += vector(100);
    }
    if (one(10)) body.setVelocity(vector(50));
}

void RandomProgram::writeBadNodes()
{
    btSoftBody::Node& node = anyNode(*anySoft());
    switch (below(4))
    {
        case 0:
            node.m_x[below(3)] = badNumber();
            break;
        case 1:
            node.m_v[below(3)] = badNumber();
            break;
        case 2:
            node.m_f[below(3)] = badNumber();
            break;
        default:
            node.m_im = badNumber();
            break;
    }
}

void RandomProgram::pin()
{
    btSoftBody& body = *anySoft();
    const int node = below(body.m_nodes.size());
    body.setMass(node, one(2) || m_manner == Manner::gentle ? 0 : btScalar(logarithmic(1e-3, 10)));
    if (bad(20))
        for (int i = 0; i < body.m_nodes.size(); ++i) body.setMass(i, 0);
}

void RandomProgram::setMasses()
{
    btSoftBody& body = *anySoft();
    if (one(2))
        body.setTotalMass(btScalar(logarithmic(1e-3, 1e3)));
    else
        body.setVolumeDensity(btScalar(logarithmic(1, 1e4)));
}

void RandomProgram::setTargets()
{
    btSoftBody& body = *anySoft();
    const int node = nodeOf(body);
    if (one(3))
        m_fem.setNodeTargets(&body, &node, 1, pose(0.5));
    else
        m_fem.setNodeTarget(&body, node, one(15) ? btVector3(badNumber(), 0, 0) : place());
}

void RandomProgram::clearTargets()
{
    btSoftBody& body = *anySoft();
    for (int i = 0; i < body.m_nodes.size(); ++i) m_fem.clearNodeTarget(&body, i);
}

void RandomProgram::anchor()
{
    btSoftBody& body = *anySoft();
    if (one(4) && body.m_anchors.size() > 0)
        body.removeAnchor(static_cast<int>(body.m_anchors[0].m_node - &body.m_nodes[0]));
    else if (m_fem.isFem(&body))
        body.appendAnchor(below(body.m_nodes.size()), anyRigid(), one(2), btScalar(number(0, 1)));
}

void RandomProgram::attach()
{
    btSoftBody &a = *anySoft(), &b = *anySoft();
    const btScalar weights[4] = {btScalar(0.25), btScalar(0.25), btScalar(0.25), btScalar(0.25)};
    m_attachments.push_back(one(2) ? m_fem.attachNodes(&a, nodeOf(a), &b, nodeOf(b))
                                   : m_fem.attachNodeToTet(&a, nodeOf(a), &b, below(b.m_tetras.size() + 1), weights));
}

void RandomProgram::detach()
{
    btSoftBody* body = anySoft();
    for (int handle : m_attachments) m_fem.detach(body, handle);
}

void RandomProgram::spring()
{
    btSoftBody& body = *anySoft();
    if (!m_springs.empty() && one(2))
    {
        const int handle = m_springs[below(static_cast<int>(m_springs.size()))];
        if (one(2))
            m_fem.removeSpring(&body, handle);
        else
            m_fem.setSpringTarget(&body, handle, one(10) ? btVector3(badNumber(), 0, 0) : place());
        return;
    }
    btFemSpring spring;
    spring.m_nodes[0] = nodeOf(body);
    spring.m_target = place();
    spring.m_stiffness = btScalar(logarithmic(1, 1e9));
    spring.m_damping = btScalar(one(2) ? 0 : logarithmic(1, 1e6));
    m_springs.push_back(m_fem.addSpring(&body, spring));
}

void RandomProgram::move()
{
    btSoftBody& body = *anySoft();
    switch (below(3))
    {
        case 0:
            body.translate(vector(0.3));
            break;
        case 1:
            body.rotate(pose(0).getRotation());
            break;
        default:
            body.transform(pose(0.3));
            break;
    }
}

void RandomProgram::scale()
{
    const double s = logarithmic(0.5, 2);
    anySoft()->scale(btVector3(btScalar(s), btScalar(s * number(0.8, 1.2)), btScalar(one(30) ? 0 : s)));
}

void RandomProgram::remember()
{
    anySoft()->initializeDmInverse();
}

// Bullet's appendNode may reallocate the nodes, and leaves pointers of tetrahedra, clusters and joints dangling.
void RandomProgram::append()
{
    btSoftBody& body = *anySoft();
    forgetJoints();
    body.releaseClusters();
    std::vector<std::ptrdiff_t> corners;
    for (int t = 0; t < body.m_tetras.size(); ++t)
        for (btSoftBody::Node* node : body.m_tetras[t].m_n) corners.push_back(node - &body.m_nodes[0]);
    const int n = body.m_nodes.size();
    body.appendNode(anyNode(body).m_x + vector(0.1), 1);
    for (std::size_t k = 0; k < corners.size(); ++k)
        body.m_tetras[static_cast<int>(k / 4)].m_n[k % 4] = &body.m_nodes[static_cast<int>(corners[k])];
    body.appendTetra(below(n), below(n), below(n), n);
}

void RandomProgram::removeTets()
{
    btSoftBody& body = *anySoft();
    if (body.m_tetras.size() > 1) body.m_tetras.pop_back();  // without any the body is Bullet's
}

void RandomProgram::prepare()
{
    m_fem.prepare(anySoft(), btScalar(logarithmic(1e-4, 0.1)));
}

void RandomProgram::refactor()
{
    m_fem.refactor(anySoft());
}

void RandomProgram::save()
{
    m_fem.saveState(m_state);
}

void RandomProgram::restore()
{
    if (!m_state.empty() && one(3)) m_state[below(static_cast<int>(m_state.size()))] ^= 1 << below(8);
    m_fem.restoreState(m_state.data(), m_state.size());
}

void RandomProgram::define()
{
    m_fem.saveDefinition(anySoft(), m_definition);
}

void RandomProgram::redefine()
{
    m_fem.applyDefinition(anySoft(), m_definition.data(), m_definition.size());
}

void RandomProgram::query()
{
    btSoftBody* body = anySoft();
    btAlignedObjectArray<btFemStress> stress;
    btAlignedObjectArray<btScalar> vonMises;
    btAlignedObjectArray<btVector3> forces;
    m_fem.getStress(body, stress);
    m_fem.getNodeVonMises(body, vonMises);
    m_fem.getContactForces(body, forces);
    m_fem.touches(body);
    m_fem.anchors(body);
    m_fem.contacts(body);
    const btVector3 from = place() + btVector3(0, 0, 3), to = from - btVector3(0, 0, 5);
    btCollisionWorld::ClosestRayResultCallback ray(from, to);
    m_world.bullet().rayTest(from, to, ray);
    struct Contacts : btCollisionWorld::ContactResultCallback
    {
        btScalar addSingleResult(btManifoldPoint&, const btCollisionObjectWrapper*, int, int,
                                 const btCollisionObjectWrapper*, int, int) override
        {
            return 0;
        }
    } contacts;
    m_world.bullet().contactTest(body, contacts);
    if (!m_rigid.empty()) m_world.bullet().contactPairTest(body, anyRigid(), contacts);
    if (!m_rigid.empty()) m_fem.contactForce(body, anyRigid());
}

void RandomProgram::setGravity()
{
    const btVector3 gravity = one(3) ? vector(30) : btVector3(0, 0, btScalar(-kGravity));
    m_world.bullet().setGravity(gravity);
    m_world.setSoftGravity(gravity);
}

void RandomProgram::makeClusters()
{
    btSoftBody &a = *anySoft(), &b = *anySoft();
    forgetJoints();
    a.generateClusters(1 + below(4));
    b.generateClusters(1);
    if (&a == &b || a.m_clusters.size() == 0 || b.m_clusters.size() == 0) return;
    btSoftBody::LJoint::Specs specs;
    specs.position = place();
    a.appendLinearJoint(specs, &b);
}

void RandomProgram::setPose()
{
    btSoftBody* body = anySoft();
    body->setPose(one(2), one(2));
    body->m_cfg.kMT = btScalar(number(0, 1));
}

void RandomProgram::setActivation()
{
    const int states[] = {ACTIVE_TAG, ISLAND_SLEEPING, WANTS_DEACTIVATION, DISABLE_DEACTIVATION, DISABLE_SIMULATION};
    if (one(2))
        anySoft()->forceActivationState(states[below(5)]);
    else
        anyRigid()->forceActivationState(states[below(4)]);
}

// Equal steps from equal states are bitwise equal, as long as Bullet's broad phase finds pairs in an equal order, which
// depends on the history of its trees.
void RandomProgram::replay()
{
    if (m_soft.empty()) return;
    stepWorld(1, 1.0 / 60);  // bodies added since the last step are not saved before it
    m_fem.saveState(m_state);
    const BulletState state(m_world);
    constexpr int kReplayed = 5;  // steps
    std::vector<int> pairs[2][kReplayed];
    std::vector<btScalar> bits[2][kReplayed];
    for (int way = 0; way < 2; ++way)
    {
        m_fem.restoreState(m_state.data(), m_state.size());
        state.restore(m_world);
        for (int k = 0; k < kReplayed; ++k)
        {
            stepWorld(1, 1.0 / 60);
            pairs[way][k] = pairOrder();
            for (const btSoftBody* body : m_soft) addTo(bits[way][k], bitsOf(*body));
        }
    }
    for (int k = 0; k < kReplayed && pairs[0][k] == pairs[1][k]; ++k)
        m_replayed = m_replayed && bits[0][k].size() == bits[1][k].size() &&
                     std::memcmp(bits[0][k].data(), bits[1][k].data(), bits[0][k].size() * sizeof(btScalar)) == 0;
}

std::vector<int> RandomProgram::pairOrder()
{
    std::vector<int> order;
    const btBroadphasePairArray& pairs =
        m_world.bullet().getBroadphase()->getOverlappingPairCache()->getOverlappingPairArray();
    for (int k = 0; k < pairs.size(); ++k)
    {
        order.push_back(pairs[k].m_pProxy0->m_uniqueId);
        order.push_back(pairs[k].m_pProxy1->m_uniqueId);
    }
    return order;
}

}  // namespace bullet_fem

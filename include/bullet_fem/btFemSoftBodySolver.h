// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "BulletSoftBody/btDefaultSoftBodySolver.h"
#include "bullet_fem/btFemActuators.h"
#include "bullet_fem/btFemAnchors.h"
#include "bullet_fem/btFemInterest.h"
#include "bullet_fem/btFemMaterial.h"
#include "bullet_fem/btFemPrecision.h"
#include "bullet_fem/btFemReactions.h"
#include "bullet_fem/btFemReports.h"
#include "bullet_fem/btFemSolverInfo.h"
#include "bullet_fem/btFemSpring.h"
#include "bullet_fem/fem/common/export.h"

class btSoftBody;
struct btFemCoupling;

namespace bullet_fem
{
struct BakedBody;  // bullet_fem/fem/baked/baked_body.h
}

/// Makes every tetrahedral btSoftBody of a btSoftRigidDynamicsWorld a corotational finite-element body: give it to the
/// world's constructor in place of the default solver. Bodies without tetrahedra keep Bullet's behaviour, bit for bit,
/// but for what they touch of FEM bodies (VF_SS in both).
///
/// Lifetime: outlives its world. Threads: call from the thread that steps the world; processCollision may be called by
/// Bullet's threads. Allocates when a body is first stepped, when the number of contacts grows, and on calls of its own
/// methods; not otherwise, but for the tasks of btFemSolverInfo::m_threads > 1, which come from oneTBB's pools.
///
/// Whichever way a body was made, its tetrahedra count. One without faces is given those of its boundary. Links are
/// ignored, whoever made them: a FEM body's stiffness is its material's. Pieces that only links connect part.
/// Nodes and tetrahedra may be appended or removed at any time: the body is set up anew in the next step, with its
/// material, detail and contact offset, without node targets and attachments (BT_FEM_CHANGED_MESH). Elements without a
/// matrix, as appendTetra makes them, make the shape of then the rest shape: initializeDmInverse says so beforehand.
///
/// Bodies sleep like Bullet's rigid ones: after 2 s (gDeactivationTime) in which no node was faster than
/// m_sleepingThreshold (.04 m/s), with their island. A step with a node up to four times as fast costs four steps of
/// that time, not all of it, or piles would never sleep. Asleep they keep velocity 0, contacts and reports, those of
/// cost zeroed; what the user writes, or a change around them, wakes them. setActivationState(DISABLE_DEACTIVATION)
/// keeps a body awake.
///
/// Bullet's m_rcontacts and m_faceRigidContacts tell what a body touches: contacts() with rigid objects that carry an
/// impulse or have no gap, with the nearest node, and with the face that has the point. Valid until the next step;
/// empty while the body is not active, and from when it leaves the world (if its m_worldInfo has the world's
/// dispatcher; contacts with another object end when that leaves). Nothing solves them. Its m_fdbvt serves Bullet's
/// rayTest; the boxes in it do not tell where faces are.
///
/// Bodies are known by address and by a mark that they get when they are first stepped or prepared, in a field of their
/// first tetrahedron that Bullet 3.24 does not use (m_tetras[0].m_c0; cages also use m_c1 and m_c2 of all). What is set
/// for a body that is not in the world at the next step is forgotten.
///
/// The rest shape is the one that initializeDmInverse of btSoftBody saw last, read from m_tetras[].m_Dm_inverse: what
/// deforms a body between then and its first step is sprung back. Bodies without usable matrices (Bullet's appendTetra
/// leaves zeros) keep the shape that they have when they are first stepped or prepared. initializeDmInverse, and scale,
/// which calls it, make the present shape the rest shape at any time, from the next step on; translate, rotate and
/// transform do not. Scaling keeps the node masses, as it does in Bullet; setMaterial with a density sets those of the
/// new size.
///
/// Functions with a last argument `why` throw if that is null. Else, for engines without exceptions, they return false
/// (or 0 in place of a handle) where they would throw, with the reason in `why`, and true where all is well.
class BULLETFEM_API btFemSoftBodySolver : public btDefaultSoftBodySolver
{
public:
    /// Throws std::invalid_argument if !info.valid().
    explicit btFemSoftBodySolver(const btFemSolverInfo& info = btFemSolverInfo());
    ~btFemSoftBodySolver() override;
    btFemSoftBodySolver(const btFemSoftBodySolver&) = delete;
    btFemSoftBodySolver& operator=(const btFemSoftBodySolver&) = delete;

    /// Gives a body its material, before or after addSoftBody, at any time; a density > 0 sets the masses of nodes that
    /// are not pinned, now. Without it a body has E = 1e6 kLST Pa, nu .3, beta .005 s and its own masses. Throws
    /// std::invalid_argument on a bad material or a body without (usable) tetrahedra.
    bool setMaterial(btSoftBody* body, const btFemMaterial& material, std::string* why = nullptr);

    /// The same with a material for every tetrahedron, in the order of m_tetras. Young's modulus, Poisson's ratio,
    /// density and mean dilatation are a tetrahedron's own; the dampings must be the same in all, and a density of 0
    /// is that of all or of none. Throws std::invalid_argument, and changes nothing then, as setMaterial does, on
    /// another number of materials, and on such that do not go together; the message names tetrahedron or region.
    bool setMaterials(btSoftBody* body, const std::vector<btFemMaterial>& perTetrahedron, std::string* why = nullptr);
    /// By regions: a label for every tetrahedron, such as TetMeshFile::m_regions, and the materials of the labels.
    /// Throws std::invalid_argument, and changes nothing then, as the function above does, and on a label without
    /// material; labels that no tetrahedron has do no harm.
    bool setMaterials(btSoftBody* body, const std::vector<int>& labels, const std::map<int, btFemMaterial>& ofLabel,
                      std::string* why = nullptr);
    /// By place: `materialAt` is called now, once for every tetrahedron with its centroid [m] in the rest shape, where
    /// that lay when the body was first stepped or prepared, or lies now. Where nu is above .4 a few materials, in
    /// steps, serve better than one that changes from each tetrahedron to the next: those that share a volume change
    /// are of one material (docs/materials.md). So fibres get a direction that changes from place to place. Throws
    /// std::invalid_argument, and changes nothing then, on materials that do not go together, and passes on exceptions
    /// of `materialAt`.
    bool setMaterials(btSoftBody* body, const std::function<btFemMaterial(const btVector3& centroid)>& materialAt,
                      std::string* why = nullptr);

    /// Chooses between accuracy and speed for a body, whatever its interest; btFemDetail::automatic, which it is unless
    /// called, leaves that to the interest again. Throws std::invalid_argument on null.
    bool setDetail(btSoftBody* body, btFemDetail detail, std::string* why = nullptr);

    /// Chooses the details of all other bodies by how much they matter, from the next step on. The function must live
    /// until it is replaced, or the solver is gone; null, which it is unless called, makes all of them nodalWarp.
    /// Throws std::invalid_argument if !policy.valid().
    bool setInterest(btFemInterest* interest, const btFemDetailPolicy& policy = btFemDetailPolicy(),
                     std::string* why = nullptr);

    /// Makes the body FEM, unless it is, with the rest shape of now, and factors now for a step of fixedTimeStep
    /// [s], in [1e-6, 1], so that the first step does not hitch. Throws std::invalid_argument on a bad step or mesh,
    /// and std::runtime_error if masses and moduli are so far apart that rounding makes the factor none.
    bool prepare(btSoftBody* body, btScalar fixedTimeStep, std::string* why = nullptr);

    /// Gives a body that btFemHelpers::createFromBaked made of it, or one with the same nodes and tetrahedra, its rest
    /// shape, material and factor: when it is stepped or prepared next nothing is factored. Before addSoftBody or
    /// after. If the step, masses, pins, or a material that setMaterial gives before then, are others than those that
    /// it was baked for, the factor is stale: that costs iterations (BT_FEM_STALE_FACTOR), and it is replaced like any
    /// other. The file's data live as long as a body uses them. All else that was known of the body, but for detail and
    /// contact offset, is forgotten. Throws std::invalid_argument if nodes or tetrahedra are others.
    bool useBaked(btSoftBody* body, const bullet_fem::BakedBody& baked, std::string* why = nullptr);

    /// Factors anew for the present masses and pins and the last step size. Throws std::invalid_argument if the body is
    /// not FEM, and std::runtime_error as prepare() does: then it keeps the factor that it has.
    bool refactor(btSoftBody* body, std::string* why = nullptr);

    /// Makes a node go to a world position [m] within the next step, and stay there; its mass is kept for when it is
    /// let go. Throws std::invalid_argument on a node index out of range, a position that is not in [-1e6, 1e6] m, or a
    /// body that is not FEM.
    bool setNodeTarget(btSoftBody* body, int node, const btVector3& position, std::string* why = nullptr);
    /// Lets the node go. Throws std::invalid_argument on a node index out of range, or a body that is not FEM.
    bool clearNodeTarget(btSoftBody* body, int node, std::string* why = nullptr);

    /// The same for `count` nodes at once: to positions, or to where `fromRest` moves the places of the rest shape,
    /// laid over the body as it was when first stepped or prepared. Throws std::invalid_argument like setNodeTarget,
    /// before any node has got a target.
    bool setNodeTargets(btSoftBody* body, const int* nodes, int count, const btVector3* positions,
                        std::string* why = nullptr);
    /// The same, to places that a rigid motion gives: see above.
    bool setNodeTargets(btSoftBody* body, const int* nodes, int count, const btTransform& fromRest,
                        std::string* why = nullptr);
    /// Lets `count` nodes go. Throws std::invalid_argument on a node out of range, or a body that is not FEM.
    bool clearNodeTargets(btSoftBody* body, const int* nodes, int count, std::string* why = nullptr);

    /// Ties a node to a node of another FEM body, or of the same one, until detach() or until one of them leaves the
    /// world; what lies apart is drawn together. Anchors to rigid bodies are made by Bullet's own appendAnchor, joints
    /// of clusters by its appendLinearJoint and appendAngularJoint. `a` may be cloth, too, a body without tetrahedra:
    /// then `b` has the attachment, for detach() and anchors(). Returns a handle, > 0. Throws std::invalid_argument on
    /// a body that is not FEM, or a node out of range.
    int attachNodes(btSoftBody* a, int nodeA, btSoftBody* b, int nodeB, std::string* why = nullptr);
    /// Ties a node to a point of tetrahedron tetB of another body, with barycentric weights [-] of sum 1, until
    /// detach() or until one of them leaves the world. Returns a handle, > 0. Throws std::invalid_argument on a body
    /// that is not FEM, a node or tetrahedron out of range, or weights of another sum.
    int attachNodeToTet(btSoftBody* a, int nodeA, btSoftBody* b, int tetB, const btScalar weights[4],
                        std::string* why = nullptr);
    /// Unties what attachNodes or attachNodeToTet of body `a` returned (of cloth, `b`); nothing if that is gone. Throws
    /// std::invalid_argument if `a` is not FEM.
    bool detach(btSoftBody* a, int attachment, std::string* why = nullptr);

    /// Pulls a point of the body to a place from the next step on, until removeSpring() or until the body leaves the
    /// world. Returns a handle, > 0; anchors() tells its impulse. Throws std::invalid_argument on a body that is not
    /// FEM, if !spring.valid(), or on a node with a weight that is out of range.
    int addSpring(btSoftBody* body, const btFemSpring& spring, std::string* why = nullptr);
    /// Moves what a spring pulls to [m]. Throws std::invalid_argument on a spring that the body does not have, or a
    /// target that is not in [-1e6, 1e6] m.
    bool setSpringTarget(btSoftBody* body, int spring, const btVector3& target, std::string* why = nullptr);
    /// Nothing if the spring is gone. Throws std::invalid_argument if the body is not FEM.
    bool removeSpring(btSoftBody* body, int spring, std::string* why = nullptr);

    /// Gives every tetrahedron a stress [Pa] besides that of its strain, from the next step on: what is left of how it
    /// was made, or comes of heat, -3 K alpha dT on the diagonal. In the axes of the rest shape, which turn with the
    /// element; in the order of m_tetras; an empty array for none. getStress() shows it with the rest. It may change
    /// in every step, costs no new factor, and wakes the body. Lost when the body's mesh changes. Throws
    /// std::invalid_argument on a body that is not FEM, another number of tetrahedra, or a value that is not in [-1e13,
    /// 1e13] Pa.
    bool setInitialStress(btSoftBody* body, const btAlignedObjectArray<btFemStress>& perElement,
                          std::string* why = nullptr);

    /// @name Actuators (docs/actuation.md)
    /// They act from the next step on, until removeActuator() or until the body leaves the world or its mesh changes. A
    /// later change wakes the body. Each returns a handle, > 0, and throws std::invalid_argument on a body that is not
    /// FEM, within a step, on values out of the range that the struct tells, and on nodes or tetrahedra that the body
    /// does not have.
    /// @{

    /// Adds a chamber of gas. Throws also if its surface is not closed, or not in one connected component of the body.
    int addChamber(btSoftBody* body, const btFemChamber& chamber, std::string* why = nullptr);
    /// Adds a cable with a tension or a rest length. Throws also if it is not in one connected component of the body.
    int addCable(btSoftBody* body, const btFemCable& cable, std::string* why = nullptr);
    /// Adds muscle fibres with an activation.
    int addFibres(btSoftBody* body, const btFemFibres& fibres, std::string* why = nullptr);
    /// Adds expansion by heat or growth.
    int addExpansion(btSoftBody* body, const btFemExpansion& expansion, std::string* why = nullptr);
    /// @}

    /// Opens a chamber to a pump that keeps this pressure above the outside [Pa]. These throw std::invalid_argument on
    /// a handle that the body has not, within a step, or on a value out of the range that the struct tells.
    bool setChamberPressure(btSoftBody* body, int chamber, btScalar pressure, std::string* why = nullptr);
    /// Closes it, with so much gas in it: absolute pressure times volume [J].
    bool setChamberGas(btSoftBody* body, int chamber, btScalar gas, std::string* why = nullptr);
    /// Closes it, with the gas that it has now; nothing if it is closed.
    bool sealChamber(btSoftBody* body, int chamber, std::string* why = nullptr);
    bool setCableTension(btSoftBody* body, int cable, btScalar tension, std::string* why = nullptr);    ///< [N]
    bool setCableRestLength(btSoftBody* body, int cable, btScalar length, std::string* why = nullptr);  ///< [m]
    bool setActivation(btSoftBody* body, int fibres, btScalar activation, std::string* why = nullptr);  ///< [Pa]
    bool setExpansion(btSoftBody* body, int expansion, btScalar strain, std::string* why = nullptr);    ///< [-]
    /// Nothing if it is gone.
    bool removeActuator(btSoftBody* body, int actuator, std::string* why = nullptr);

    /// All that drives the body, as it is now: chambers, cables, fibres, expansions, each in the order in which they
    /// were added. False, and an empty array, if the body is not FEM. Allocates only when the array grows.
    bool getActuators(const btSoftBody* body, btAlignedObjectArray<btFemActuatorReport>& actuators) const;

    /// Keeps the surface this far from others [m], in [0, 1e3]; 0 unless called. Bullet's shape margin is ignored.
    /// Throws std::invalid_argument on null, or out of the range.
    bool setContactOffset(btSoftBody* body, btScalar metres, std::string* why = nullptr);

    /// Drops all that is known of a body: before deleting one that was never added.
    void forget(btSoftBody* body);

    /// True if the body's tetrahedra can become finite elements: what setMaterial and prepare throw about; else `why`
    /// (if given) has their message. For engines without exceptions.
    static bool valid(const btSoftBody* body, std::string* why = nullptr);

    /// True if the body is moved by finite elements.
    bool isFem(const btSoftBody* body) const;

    /// The last step of a body; empty if it is not known.
    const btFemStepReport& stepReport(const btSoftBody* body) const;

    /// Contact points of the last step; empty if the body is not known. Valid until the next step; kept while it
    /// sleeps.
    const btAlignedObjectArray<btFemContact>& contacts(const btSoftBody* body) const;

    /// Anchors, attachments and joints of the last step with their impulses; empty if the body is not known. Valid
    /// until the next step; kept while it sleeps.
    const btAlignedObjectArray<btFemAnchorReport>& anchors(const btSoftBody* body) const;

    /// What the body touches, in the order in which it came; empty if the body is not known. Valid until the next step;
    /// of a body that sleeps what lasts is kept. A step is one of Bullet's sub-steps: who takes several at a time and
    /// must not miss one looks from the world's tick callback, which sees the touches of the sub-step before.
    const btAlignedObjectArray<btFemTouch>& touches(const btSoftBody* body) const;

    /// Mean force of another body on this one during the last step: sum of impulses / h [N]; zero if the body is not
    /// known.
    btVector3 contactForce(const btSoftBody* body, const btCollisionObject* other) const;

    /// Mean force of contact on every node during the last step [N], in the order of m_nodes: each point's impulse / h,
    /// shared out by the weights of its nodes (of self contact the one side that contacts() tells). False, and an empty
    /// array, if the body is not FEM, or its arrays were changed since. Allocates only when the array grows.
    bool getContactForces(const btSoftBody* body, btAlignedObjectArray<btVector3>& perNode) const;

    /// Reaction force at a held node in the last step, on the body [N]: see btFemReaction. Zero at nodes that are
    /// free, or do not exist, and where nothing is known: before the first step, after restoreState(), and where
    /// refactor() made another factor, until the next; of bodies that are not FEM. A body that sleeps keeps its last
    /// ones. What it costs, a twentieth of a step, is spent at the first of these calls after a step. From the thread
    /// that steps the world.
    btVector3 reactionForce(const btSoftBody* body, int node) const;
    /// The same of every node, in the order of m_nodes. False, and an empty array, where no node is held or nothing is
    /// known. Allocates only when the array grows.
    bool getReactionForces(const btSoftBody* body, btAlignedObjectArray<btVector3>& perNode) const;
    /// Sum over the held nodes among these, each as often as it is named, with the moment about a place [m].
    btFemReaction reaction(const btSoftBody* body, const int* nodes, int count, const btVector3& about) const;
    /// Sum over all held nodes.
    btFemReaction reaction(const btSoftBody* body, const btVector3& about) const;
    /// Sum over the anchors, attachments, joints and springs (see anchors()) that join the body to an object, null for
    /// the world; with the moment about a place [m], angular joints included.
    btFemReaction anchorReaction(const btSoftBody* body, const btCollisionObject* object, const btVector3& about) const;

    /// Elastic stress of every tetrahedron [Pa] where the last step left the nodes (or where prepare found them), in
    /// the order of m_tetras: R (2 mu eps + lambda tr(eps) I) R^T, Hooke's law in the frame that turns with the
    /// element, or that of its material, without viscous stress; of an element of a cage that is partly filled, the
    /// stress of what fills it. Never throws: false, and an empty array, if the body is not FEM, or its arrays were
    /// changed since. Allocates only when an array grows, here or in the solver. From the thread that steps the world.
    bool getStress(const btSoftBody* body, btAlignedObjectArray<btFemStress>& perElement) const;
    /// The mean of the elements at every node by their (filled) volumes, in the order of m_nodes: smooth for drawing,
    /// and lower than the elements' peaks. Zero at nodes that no element uses. False, and an empty array, as getStress
    /// returns them. Allocates only when an array grows.
    bool getNodeStress(const btSoftBody* body, btAlignedObjectArray<btFemStress>& perNode) const;
    /// Von Mises' equivalent of getStress, one a tetrahedron [Pa], >= 0. False, and an empty array, as getStress
    /// returns them. Allocates only when an array grows.
    bool getVonMises(const btSoftBody* body, btAlignedObjectArray<btScalar>& perElement) const;
    /// Von Mises' equivalent of getNodeStress, one a node [Pa], >= 0. False, and an empty array, as getStress returns
    /// them. Allocates only when an array grows.
    bool getNodeVonMises(const btSoftBody* body, btAlignedObjectArray<btScalar>& perNode) const;

    /// Equivalent plastic strain of every tetrahedron [-], >= 0, in the order of m_tetras: the sum over time of
    /// sqrt(2/3) |d eps_p|. False, and an empty array, of bodies that are not FEM, whose arrays were changed
    /// since, or that never had a material that yields. Allocates only when an array grows.
    bool getPlasticStrain(const btSoftBody* body, btAlignedObjectArray<btScalar>& perElement) const;

    /// Activation of every tetrahedron's fibres [Pa], in the order of m_tetras: the sum of those that run through it,
    /// whatever their directions. False, and an empty array, of bodies that are not FEM, whose arrays were changed
    /// since, or that have no fibres. Allocates only when an array grows.
    bool getActivation(const btSoftBody* body, btAlignedObjectArray<btScalar>& perElement) const;

    /// Saves what the next steps of the FEM bodies of the world stepped last depend on, so that restoreState continues
    /// to the bit, in the midst of contact, too: motion, rotations, warm starts, contacts, joints, pins, targets,
    /// attachments, sleep, factors, reports. The same state gives the same bytes, but on machines of another byte order
    /// or with another precision of btScalar. A std::vector, because who saves every step uses one again: it grows
    /// once. Between steps; the world must be alive. Throws std::invalid_argument within a step, or if no FEM body's
    /// m_worldInfo has the world's m_broadphase.
    bool saveState(std::vector<unsigned char>& buffer, std::string* why = nullptr) const;

    /// Puts the FEM bodies of the world back to a state that was saved of it, or of one that was built in the same way.
    /// Bodies are known by their ids in the broad phase: a body that was taken out and added again is another one.
    ///
    /// Refused, with everything left as it was: bytes that are cut off, damaged, something else's, or of another
    /// version or precision; bodies that are not in the world, or not FEM yet, or have other elements; a material that
    /// is not the one of then. FEM bodies that came since are left as they are, and what restored bodies touched or
    /// were held by that is gone is left out. A factor that is no longer there is made again, which takes its time.
    ///
    /// Not saved: what belongs to Bullet (rigid bodies, their sleep, contacts and warm starts, the order of the broad
    /// phase's pairs) and what the user sets and no step changes (material, detail, contact offset, m_cfg, gravity,
    /// wind, anchors, joints, the solver's info). For the same bits that must be as it was. Bullet's contacts between
    /// rigid bodies cannot be put back: take all pairs out of the pair cache (removeOverlappingPair) and add them again
    /// in their order, after saving as after restoring, so that they begin anew both times. m_cid and m_newpairs of
    /// btDbvtBroadphase decide in which step it drops old pairs: put these back, too. A rigid solver with
    /// SOLVER_RANDMIZE_ORDER wants its getRandSeed() back by setRandSeed(). A factor being made in the background is
    /// dropped. Between steps. Throws std::invalid_argument with the reason.
    bool restoreState(const unsigned char* data, std::size_t size, std::string* why = nullptr);

    /// Saves what makes a body the FEM body that it is, for a side-car to whatever keeps its nodes, because Bullet's
    /// serializer loses it: rest shape, material, masses and pins, filled fractions of a cage, contact offset, detail.
    /// (Bullet 3.24's btSoftBody::serialize writes beyond its buffer in double precision; nothing here calls it.) A
    /// body that was not stepped or prepared yet has its present shape as rest shape. Throws std::invalid_argument on
    /// null, or a body without usable tetrahedra.
    bool saveDefinition(const btSoftBody* body, std::vector<unsigned char>& buffer, std::string* why = nullptr) const;

    /// Gives it to a body with the same nodes and tetrahedra that was restored by other means: its nodes keep their
    /// positions and velocities, and get their masses and pins at once; the rest is used when it is stepped or prepared
    /// next, or forgotten if nodes or tetrahedra come or go until then. All that was known of the body is forgotten,
    /// its targets and attachments too. In place of setMaterial, and before addSoftBody or after. Throws
    /// std::invalid_argument with the reason, and changes nothing then.
    bool applyDefinition(btSoftBody* body, const unsigned char* data, std::size_t size, std::string* why = nullptr);

    /// @name Called by the world
    /// @{

    /// The stages of a step (docs/architecture.md), with what Bullet does to bodies that are not FEM. The step is in s.
    void optimize(btAlignedObjectArray<btSoftBody*>& softBodies, bool forceUpdate = false) override;
    void predictMotion(btScalar timeStep) override;
    void processCollision(btSoftBody* body, const btCollisionObjectWrapper* other) override;
    void processCollision(btSoftBody* body, btSoftBody* other) override;
    void solveConstraints(btScalar timeStep) override;
    void updateSoftBodies() override;
    /// @}

private:
    friend struct btFemCoupling;
    struct Impl;
    std::unique_ptr<Impl> m_impl;
};

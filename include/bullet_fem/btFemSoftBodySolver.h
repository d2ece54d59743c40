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
/// world's constructor instead of the default solver. Bodies without tetrahedra behave as in Bullet, bit for bit,
/// except in contact with FEM bodies (VF_SS in both).
///
/// Lifetime: must outlive its world. Threads: call from the thread that steps the world; processCollision may be called
/// by Bullet's threads. Allocates when a body is first stepped, when the number of contacts grows, and in calls of its
/// own methods; not otherwise, except for tasks of btFemSolverInfo::m_threads > 1, which come from oneTBB's pools.
///
/// Every body with tetrahedra is considered, however it was made. A body without faces gets those of its boundary.
/// Links are ignored: the stiffness of a FEM body comes from its material, and components connected by links only move
/// separately. Nodes and tetrahedra may be appended or removed at any time: the body is set up anew in the next step,
/// with its material, detail and contact offset, without node targets and attachments (BT_FEM_CHANGED_MESH). Elements
/// without a rest matrix, as appendTetra makes them, take the shape at that time as rest shape; call
/// initializeDmInverse beforehand to make that explicit.
///
/// Bodies sleep as Bullet's rigid bodies do: with their island, after 2 s (gDeactivationTime) in which no node was
/// faster than m_sleepingThreshold (.04 m/s). A step with a node up to four times as fast sets this time back by four
/// steps instead of to zero, or piles would never sleep. Sleeping bodies keep velocity 0, contacts and reports, with
/// zero cost figures. Any value that the program writes, or a change around them, wakes them.
/// setActivationState(DISABLE_DEACTIVATION) keeps a body awake.
///
/// Bullet's m_rcontacts and m_faceRigidContacts list the contacts() with rigid objects that carry an impulse or have no
/// gap, with the nearest node and with the face of the point. Valid until the next step, and in sleep; empty with
/// DISABLE_SIMULATION, and after the body leaves the world (if its m_worldInfo has the world's dispatcher; contacts
/// with another object end when that leaves). Bullet does not solve them. m_fdbvt serves Bullet's rayTest; its boxes do
/// not bound the faces.
///
/// Bodies are identified by address and by a mark, set when they are first stepped or prepared, in a field of their
/// first tetrahedron that Bullet 3.24 does not use (m_tetras[0].m_c0; cages also use m_c1 and m_c2 of all). Settings of
/// a body that is not in the world at the next step are dropped.
///
/// The rest shape is that of the last call of btSoftBody::initializeDmInverse, read from m_tetras[].m_Dm_inverse:
/// deformation between that call and the first step is elastic strain. Bodies without usable matrices (Bullet's
/// appendTetra leaves zeros) take their shape when first stepped or prepared. initializeDmInverse, and scale, which
/// calls it, make the present shape the rest shape at any time, from the next step on; translate, rotate and transform
/// do not. Scaling keeps the node masses, as in Bullet; setMaterial with a density sets those of the new size.
///
/// Functions with a last argument `why` throw if it is null. Otherwise, for engines without exceptions, they do not
/// throw: they write the reason to `why` and return false (or 0 instead of a handle), and return true on success.
class BULLETFEM_API btFemSoftBodySolver : public btDefaultSoftBodySolver
{
public:
    /// Throws std::invalid_argument if !info.valid().
    explicit btFemSoftBodySolver(const btFemSolverInfo& info = btFemSolverInfo());
    ~btFemSoftBodySolver() override;
    btFemSoftBodySolver(const btFemSoftBodySolver&) = delete;
    btFemSoftBodySolver& operator=(const btFemSoftBodySolver&) = delete;

    /// Sets a body's material, before or after addSoftBody, at any time. A density > 0 sets the masses of nodes that
    /// are not pinned, immediately. Without a material a body has E = 1e6 kLST Pa, nu .3, beta .005 s and its own
    /// masses. Throws std::invalid_argument on an invalid material or a body without (usable) tetrahedra.
    bool setMaterial(btSoftBody* body, const btFemMaterial& material, std::string* why = nullptr);

    /// Sets one material per tetrahedron, in the order of m_tetras. Their two dampings must be equal, and a density of
    /// 0 must be that of all or none; other values may differ as docs/materials.md (Several materials in a body) says.
    /// Throws std::invalid_argument, naming tetrahedron or region, as setMaterial does, and on a wrong number of
    /// materials or incompatible ones; the body is unchanged then.
    bool setMaterials(btSoftBody* body, const std::vector<btFemMaterial>& perTetrahedron, std::string* why = nullptr);
    /// Sets materials by region: one label per tetrahedron, such as TetMeshFile::m_regions, and one material per label;
    /// labels without tetrahedra are ignored. Throws std::invalid_argument, naming tetrahedron or region, as
    /// setMaterial does, and on a wrong number of labels, a label without material, or incompatible materials; the body
    /// is unchanged then.
    bool setMaterials(btSoftBody* body, const std::vector<int>& labels, const std::map<int, btFemMaterial>& ofLabel,
                      std::string* why = nullptr);
    /// Sets materials by position: `materialAt` is called in this call, once per tetrahedron, with the centroid [m] in
    /// the rest shape, placed where the body was when first stepped or prepared, or else where it is now. Serves fibre
    /// directions that vary in space. For nu above .4 prefer a few regions to a material that differs between all
    /// tetrahedra: only elements of one material share a volume change (docs/materials.md). Throws
    /// std::invalid_argument on invalid or incompatible materials, and passes on exceptions of `materialAt`; the body
    /// is unchanged then.
    bool setMaterials(btSoftBody* body, const std::function<btFemMaterial(const btVector3& centroid)>& materialAt,
                      std::string* why = nullptr);

    /// Sets a body's detail, independent of its interest; btFemDetail::automatic, the initial value, leaves it to the
    /// interest. Throws std::invalid_argument on null.
    bool setDetail(btSoftBody* body, btFemDetail detail, std::string* why = nullptr);

    /// Sets the interest by which the detail of all bodies with btFemDetail::automatic is chosen, from the next step
    /// on. The object must live until it is replaced or the solver is destroyed; null, the initial value, gives all of
    /// them nodalWarp. Throws std::invalid_argument if !policy.valid().
    bool setInterest(btFemInterest* interest, const btFemDetailPolicy& policy = btFemDetailPolicy(),
                     std::string* why = nullptr);

    /// Makes the body FEM, unless it is, with its present rest shape, and factors for a step of fixedTimeStep [s], in
    /// [1e-6, 1], so that the first step takes no longer than others. Throws std::invalid_argument on a bad step or
    /// mesh, and std::runtime_error if masses and moduli differ so widely that the matrix is not positive definite to
    /// rounding. Allocates.
    bool prepare(btSoftBody* body, btScalar fixedTimeStep, std::string* why = nullptr);

    /// Sets rest shape, material and factor from a baked body, on a body that btFemHelpers::createFromBaked made of it,
    /// or one with equal nodes and tetrahedra: nothing is factored when it is next stepped or prepared. Before or after
    /// addSoftBody. If step, masses, pins, or a material set before then differ from the baked ones, the factor is
    /// stale: that costs iterations (BT_FEM_STALE_FACTOR), and it is replaced like any other. The file's data live as
    /// long as a body uses them. All other settings and state of the body, except detail and contact offset, are
    /// dropped. Throws std::invalid_argument if nodes or tetrahedra differ.
    bool useBaked(btSoftBody* body, const bullet_fem::BakedBody& baked, std::string* why = nullptr);

    /// Computes a new factor for the present masses and pins and the last step size. Throws std::invalid_argument if
    /// the body is not FEM, and std::runtime_error as prepare() does; the body keeps its factor then. Allocates.
    bool refactor(btSoftBody* body, std::string* why = nullptr);

    /// Prescribes the motion of a node: it moves to a world position [m] within the next step and stays there. Its mass
    /// is kept for its release. Throws std::invalid_argument on a node index out of range, a position outside [-1e6,
    /// 1e6] m, or a body that is not FEM.
    bool setNodeTarget(btSoftBody* body, int node, const btVector3& position, std::string* why = nullptr);
    /// Releases a node from its target. Throws std::invalid_argument on a node index out of range, or a body that is
    /// not FEM.
    bool clearNodeTarget(btSoftBody* body, int node, std::string* why = nullptr);

    /// Prescribes the motion of `count` nodes to world positions [m], one per node. Throws std::invalid_argument on a
    /// node index out of range, a position outside [-1e6, 1e6] m, or a body that is not FEM, before any target is set.
    bool setNodeTargets(btSoftBody* body, const int* nodes, int count, const btVector3* positions,
                        std::string* why = nullptr);
    /// Prescribes the motion of `count` nodes to fromRest(X), X the positions of the rest shape in the world, placed as
    /// the body was when first stepped or prepared [m]. Throws std::invalid_argument on a node index out of range, a
    /// position outside [-1e6, 1e6] m, or a body that is not FEM, before any target is set.
    bool setNodeTargets(btSoftBody* body, const int* nodes, int count, const btTransform& fromRest,
                        std::string* why = nullptr);
    /// Releases `count` nodes from their targets. Throws std::invalid_argument on a node index out of range, or a body
    /// that is not FEM.
    bool clearNodeTargets(btSoftBody* body, const int* nodes, int count, std::string* why = nullptr);

    /// Ties a node to a node of another FEM body or of this one, until detach() or until one of them leaves the world;
    /// nodes that are apart are pulled together. Anchors to rigid bodies are made by Bullet's appendAnchor, joints of
    /// clusters by its appendLinearJoint and appendAngularJoint. `a` may also be cloth, a body without tetrahedra: `b`
    /// then owns the attachment, for detach() and anchors(). Returns a handle, > 0. Throws std::invalid_argument on a
    /// body that is not FEM, or a node out of range.
    int attachNodes(btSoftBody* a, int nodeA, btSoftBody* b, int nodeB, std::string* why = nullptr);
    /// Ties a node to a point of tetrahedron tetB of another body, by barycentric weights [-] of sum 1, until detach()
    /// or until one of them leaves the world. Returns a handle, > 0. Throws std::invalid_argument on a body that is not
    /// FEM, a node or tetrahedron out of range, or weights of another sum.
    int attachNodeToTet(btSoftBody* a, int nodeA, btSoftBody* b, int tetB, const btScalar weights[4],
                        std::string* why = nullptr);
    /// Removes an attachment by its handle; `a` is the body that owns it (for cloth, `b`). Without effect if it no
    /// longer exists. Throws std::invalid_argument if `a` is not FEM.
    bool detach(btSoftBody* a, int attachment, std::string* why = nullptr);

    /// Adds a spring that pulls a point of the body to a target from the next step on, until removeSpring() or until
    /// the body leaves the world. Returns a handle, > 0; anchors() reports its impulse. Throws std::invalid_argument on
    /// a body that is not FEM, if !spring.valid(), or on a weighted node out of range.
    int addSpring(btSoftBody* body, const btFemSpring& spring, std::string* why = nullptr);
    /// Moves the target of a spring [m]. Throws std::invalid_argument on a handle that the body does not own, or a
    /// target outside [-1e6, 1e6] m.
    bool setSpringTarget(btSoftBody* body, int spring, const btVector3& target, std::string* why = nullptr);
    /// Removes a spring; without effect if it no longer exists. Throws std::invalid_argument if the body is not FEM.
    bool removeSpring(btSoftBody* body, int spring, std::string* why = nullptr);

    /// Sets the initial stress of every tetrahedron [Pa], added to the elastic stress from the next step on: residual
    /// stress of manufacture, or thermal stress, -3 K alpha dT on the diagonal. In the axes of the rest shape, which
    /// rotate with the element; in the order of m_tetras; an empty array clears it. getStress() includes it. It may
    /// change in every step, needs no new factor, and wakes the body. Lost when the body's mesh changes. Throws
    /// std::invalid_argument on a body that is not FEM, a wrong number of tetrahedra, or a component outside [-1e13,
    /// 1e13] Pa.
    bool setInitialStress(btSoftBody* body, const btAlignedObjectArray<btFemStress>& perElement,
                          std::string* why = nullptr);

    /// @name Actuators (docs/actuation.md)
    /// Actuators act from the next step on, until removeActuator() or until the body leaves the world or its mesh
    /// changes. A later change wakes the body. Each function that adds one returns a handle, > 0, and throws
    /// std::invalid_argument on a body that is not FEM, within a step, on values out of the struct's range, and on
    /// nodes or tetrahedra that the body does not have.
    /// @{

    /// Adds a gas chamber. Also throws if its surface is not closed, or not in one connected component of the body.
    int addChamber(btSoftBody* body, const btFemChamber& chamber, std::string* why = nullptr);
    /// Adds a cable. Also throws if it is not in one connected component of the body.
    int addCable(btSoftBody* body, const btFemCable& cable, std::string* why = nullptr);
    /// Adds muscle fibres.
    int addFibres(btSoftBody* body, const btFemFibres& fibres, std::string* why = nullptr);
    /// Adds isotropic expansion, as by heat or growth.
    int addExpansion(btSoftBody* body, const btFemExpansion& expansion, std::string* why = nullptr);
    /// @}

    /// Opens a chamber and sets its constant gauge pressure [Pa]. The set and seal functions throw
    /// std::invalid_argument on a handle that the body does not own, within a step, or on a value out of the struct's
    /// range.
    bool setChamberPressure(btSoftBody* body, int chamber, btScalar pressure, std::string* why = nullptr);
    /// Seals a chamber with a given amount of gas: absolute pressure times volume [J].
    bool setChamberGas(btSoftBody* body, int chamber, btScalar gas, std::string* why = nullptr);
    /// Seals a chamber with its present gas; without effect if it is sealed.
    bool sealChamber(btSoftBody* body, int chamber, std::string* why = nullptr);
    /// Constant tension [N].
    bool setCableTension(btSoftBody* body, int cable, btScalar tension, std::string* why = nullptr);
    /// Rest length [m].
    bool setCableRestLength(btSoftBody* body, int cable, btScalar length, std::string* why = nullptr);
    /// Activation [Pa].
    bool setActivation(btSoftBody* body, int fibres, btScalar activation, std::string* why = nullptr);
    /// Free strain [-].
    bool setExpansion(btSoftBody* body, int expansion, btScalar strain, std::string* why = nullptr);
    /// Removes an actuator; without effect if it no longer exists. Throws std::invalid_argument on a body that is not
    /// FEM, or within a step.
    bool removeActuator(btSoftBody* body, int actuator, std::string* why = nullptr);

    /// The present state of the body's actuators: chambers, cables, fibres, expansions, each kind in the order of
    /// addition. Returns false and an empty array if the body is not FEM. Allocates only when the array grows.
    bool getActuators(const btSoftBody* body, btAlignedObjectArray<btFemActuatorReport>& actuators) const;

    /// Sets the distance that the body's surface keeps from others [m], in [0, 1e3]; initially 0. Bullet's shape margin
    /// is ignored. Throws std::invalid_argument on null, or out of the range.
    bool setContactOffset(btSoftBody* body, btScalar metres, std::string* why = nullptr);

    /// Drops all settings and state of a body; to be called before deleting one that was never added to the world.
    void forget(btSoftBody* body);

    /// True if the body's tetrahedra can become finite elements; else `why` (if given) has the message that setMaterial
    /// and prepare would throw. For engines without exceptions.
    static bool valid(const btSoftBody* body, std::string* why = nullptr);

    /// True if the body is stepped as a FEM body.
    bool isFem(const btSoftBody* body) const;

    /// Report of the body's last step; all zero if the body is unknown.
    const btFemStepReport& stepReport(const btSoftBody* body) const;

    /// Contact points of the last step; empty if the body is unknown. Valid until the next step; kept while it sleeps.
    const btAlignedObjectArray<btFemContact>& contacts(const btSoftBody* body) const;

    /// Anchors, attachments, joints and springs of the last step with their impulses; empty if the body is unknown.
    /// Valid until the next step; kept while it sleeps.
    const btAlignedObjectArray<btFemAnchorReport>& anchors(const btSoftBody* body) const;

    /// Contact pairs of the body, in the order in which they began; empty if the body is unknown. Valid until the next
    /// step; a sleeping body keeps lasting ones. A step is one of Bullet's sub-steps: programs that take several per
    /// call and need every change read this in the world's tick callback, which sees the pairs of the previous
    /// sub-step.
    const btAlignedObjectArray<btFemTouch>& touches(const btSoftBody* body) const;

    /// Mean force of another body on this one during the last step, sum of impulses / h [N]; zero if the body is
    /// unknown.
    btVector3 contactForce(const btSoftBody* body, const btCollisionObject* other) const;

    /// Mean contact force on every node during the last step [N], in the order of m_nodes: each point's impulse / h,
    /// distributed by the weights of its nodes (for self contact only on the side that contacts() lists). Returns false
    /// and an empty array if the body is not FEM, or its arrays were changed since. Allocates only when the array
    /// grows.
    bool getContactForces(const btSoftBody* body, btAlignedObjectArray<btVector3>& perNode) const;

    /// Reaction force on the body at a held node in the last step [N]: see btFemReaction. Zero at nodes that are free
    /// or do not exist, for bodies that are not FEM, and while reactions are unknown: before the first step, and after
    /// restoreState() or after refactor() made another factor, until the next step. A sleeping body keeps its
    /// reactions. The first of these calls after a step costs about a twentieth of a step. To be called from the thread
    /// that steps the world.
    btVector3 reactionForce(const btSoftBody* body, int node) const;
    /// Reaction forces of all nodes [N], in the order of m_nodes. Returns false and an empty array if no node is held
    /// or reactions are unknown. Allocates only when the array grows.
    bool getReactionForces(const btSoftBody* body, btAlignedObjectArray<btVector3>& perNode) const;
    /// Sum of force [N] and moment [N m] about a point [m] over those of `count` nodes that are held, each as often as
    /// listed.
    btFemReaction reaction(const btSoftBody* body, const int* nodes, int count, const btVector3& about) const;
    /// Sum of force [N] and moment [N m] about a point [m] over all held nodes.
    btFemReaction reaction(const btSoftBody* body, const btVector3& about) const;
    /// Sum of force [N] and moment [N m] about a point [m] over the anchors, attachments, joints and springs (see
    /// anchors()) between the body and an object, null for the world; includes angular joints.
    btFemReaction anchorReaction(const btSoftBody* body, const btCollisionObject* object, const btVector3& about) const;

    /// Elastic stress of every tetrahedron [Pa] at the node positions after the last step (or after prepare), in the
    /// order of m_tetras: R (2 mu eps + lambda tr(eps) I) R^T, Hooke's law in the frame that rotates with the element,
    /// or the material's other law, plus initial stress, without viscous stress; in a partly filled element the stress
    /// of the filled share (see elementStress). Never throws: returns false and an empty array if the body is not FEM,
    /// or its arrays were changed since. Allocates only when an array grows, here or in the solver. To be called from
    /// the thread that steps the world.
    bool getStress(const btSoftBody* body, btAlignedObjectArray<btFemStress>& perElement) const;
    /// Nodal stress [Pa], in the order of m_nodes: the mean over the adjacent elements, weighted by their filled
    /// volumes; smoother than element stresses, with lower peaks. Zero at nodes that no element uses. Returns false and
    /// an empty array if the body is not FEM, or its arrays were changed since. Allocates only when an array grows.
    bool getNodeStress(const btSoftBody* body, btAlignedObjectArray<btFemStress>& perNode) const;
    /// Von Mises equivalent of getStress(), one per tetrahedron [Pa], >= 0. Returns false and an empty array if the
    /// body is not FEM, or its arrays were changed since. Allocates only when an array grows.
    bool getVonMises(const btSoftBody* body, btAlignedObjectArray<btScalar>& perElement) const;
    /// Von Mises equivalent of getNodeStress(), one per node [Pa], >= 0. Returns false and an empty array if the body
    /// is not FEM, or its arrays were changed since. Allocates only when an array grows.
    bool getNodeVonMises(const btSoftBody* body, btAlignedObjectArray<btScalar>& perNode) const;

    /// Equivalent plastic strain of every tetrahedron [-], >= 0, in the order of m_tetras: the sum over time of
    /// sqrt(2/3) |d eps_p|. Returns false and an empty array if the body is not FEM, its arrays were changed since, or
    /// it never had a material that yields. Allocates only when an array grows.
    bool getPlasticStrain(const btSoftBody* body, btAlignedObjectArray<btScalar>& perElement) const;

    /// Activation of every tetrahedron [Pa], in the order of m_tetras: the sum over its fibres, whatever their
    /// directions. Returns false and an empty array if the body is not FEM, its arrays were changed since, or it has no
    /// fibres. Allocates only when an array grows.
    bool getActivation(const btSoftBody* body, btAlignedObjectArray<btScalar>& perElement) const;

    /// Saves the complete state on which the next steps of the FEM bodies depend, for the world stepped last, so that
    /// restoreState continues with equal bits, also in contact: motion, rotations, warm starts, contacts, joints, pins,
    /// targets, attachments, sleep, factors, reports. Equal states give equal bytes on machines of one byte order and
    /// with one precision of btScalar. `buffer` grows only if it is too small, so it may be reused for every step. To
    /// be called between steps; the world must be alive. Throws std::invalid_argument within a step, or if no FEM
    /// body's m_worldInfo has the world's m_broadphase.
    bool saveState(std::vector<unsigned char>& buffer, std::string* why = nullptr) const;

    /// Restores the FEM bodies of the world to a state saved from it, or from an identically built world. Bodies are
    /// identified by their ids in the broad phase: a body that was removed and added again is another one.
    ///
    /// Throws std::invalid_argument with the reason, and changes nothing, on bytes that are truncated, damaged,
    /// foreign, or of another version or precision; on bodies that are not in the world, not FEM yet, or have other
    /// elements; and on a material that differs from the saved one. FEM bodies added since are left unchanged; contacts
    /// and joints of restored bodies with objects that no longer exist are omitted. A factor that no longer exists is
    /// computed again, which takes its time.
    ///
    /// Not saved are Bullet's data and settings that no step changes. Bullet's data are rigid bodies and multibodies,
    /// their sleep, contacts and warm starts, the order of the broad phase's pairs, and the seed of the rigid solver:
    /// btFemWorldState saves these together with the FEM bodies. Take it for bitwise equal results in worlds with
    /// movable rigid bodies.
    /// Settings are material, detail, contact offset, m_cfg, gravity, wind, anchors, joints and the solver's info. The
    /// program must restore these itself.
    /// A factorization in the background is dropped.
    /// To be called between steps.
    bool restoreState(const unsigned char* data, std::size_t size, std::string* why = nullptr);

    /// Saves the definition of a FEM body, as a companion to a file with its nodes, because Bullet's serializer drops
    /// it: rest shape, material, masses and pins, filled fractions of a cage, contact offset, detail. (Bullet 3.24's
    /// btSoftBody::serialize writes beyond its buffer in double precision; it is not called here.) A body that was
    /// never stepped or prepared is saved with its present shape as rest shape. Throws std::invalid_argument on null,
    /// or a body without usable tetrahedra.
    bool saveDefinition(const btSoftBody* body, std::vector<unsigned char>& buffer, std::string* why = nullptr) const;

    /// Applies a saved definition to a body with equal nodes and tetrahedra that was restored by other means, instead
    /// of setMaterial, before or after addSoftBody. Its nodes keep their positions and velocities, and get masses and
    /// pins immediately; the rest is used when it is next stepped or prepared, or dropped if nodes or tetrahedra are
    /// added or removed before. All other settings and state of the body are dropped, including targets and
    /// attachments. Throws std::invalid_argument with the reason; the body is unchanged then.
    bool applyDefinition(btSoftBody* body, const unsigned char* data, std::size_t size, std::string* why = nullptr);

    /// @name Called by the world
    /// @{

    /// The stages of a step (docs/architecture.md); bodies that are not FEM are passed to Bullet's solver. Times are in
    /// s.
    void optimize(btAlignedObjectArray<btSoftBody*>& softBodies, bool forceUpdate = false) override;
    void predictMotion(btScalar timeStep) override;
    void processCollision(btSoftBody* body, const btCollisionObjectWrapper* other) override;
    void processCollision(btSoftBody* body, btSoftBody* other) override;
    void solveConstraints(btScalar timeStep) override;
    void updateSoftBodies() override;

    /// Called by Bullet's collision detection: notes the constraints of the world. Always true.
    bool checkInitialized() override;
    /// @}

private:
    friend struct btFemCoupling;
    struct Impl;
    std::unique_ptr<Impl> m_impl;
};

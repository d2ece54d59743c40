// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include "LinearMath/btVector3.h"
#include "bullet_fem/btFemPrecision.h"
#include "bullet_fem/fem/common/export.h"

class btCollisionObject;

/// Accuracy of a body's free motion: the rotations of its preconditioner, and whether it is iterated to the tolerance.
/// A body in contact always is.
enum class btFemDetail
{
    nodalWarp,     ///< one rotation per node
    globalWarp,    ///< one rotation for the body [Garcia et al. 2006]; for nearly rigid bodies
    direct,        ///< globalWarp to a residual of 5 %, mostly one iteration; for unobserved bodies
    oneIteration,  ///< nodalWarp to a residual of 5 %, mostly one iteration; for hardly observed bodies
    automatic  ///< chosen by btFemSoftBodySolver::setInterest, nodalWarp without that; the default. Never in a report
};

/// Conditions of a step or of a body's set-up. Several bits may be set at once.
enum btFemFlags
{
    /// The solve reached the iteration limit before its tolerance. The result is usable; raise the limit or call
    /// refactor().
    BT_FEM_NOT_CONVERGED = 1 << 0,
    /// The system was singular to rounding, and the best iterate was kept. Check the masses and Young's modulus.
    BT_FEM_BREAKDOWN = 1 << 1,
    /// The factor was made for another step, other masses or other pins, which costs iterations. refactor() mends it.
    BT_FEM_STALE_FACTOR = 1 << 2,
    /// Some m_x or m_v was not finite, or beyond 1e6 m or m/s, and was restored to its previous value; m_f or gravity
    /// that was not finite was dropped.
    BT_FEM_RESTORED = 1 << 3,
    /// An inverse mass was negative or NaN, and the node got its share of the mass by volume; or infinite (setTotalMass
    /// by faces), and the mass of the body was redistributed by volume.
    BT_FEM_BAD_MASS = 1 << 4,
    /// The step was not in [1e-6, 1] s, and the body stood still.
    BT_FEM_BAD_STEP = 1 << 5,
    /// The mesh or the material is unusable (see m_message), and Bullet steps the body.
    BT_FEM_REJECTED = 1 << 6,
    /// The world holds the body more than once. It is stepped once; remove it once.
    BT_FEM_ADDED_TWICE = 1 << 7,
    /// The body was added to a second world or solver, which steps it. Remove it from one.
    BT_FEM_OTHER_WORLD = 1 << 8,
    /// Elements of negative orientation were reversed.
    BT_FEM_TURNED_TETS = 1 << 9,
    /// The mesh is not connected: every component moves on its own.
    BT_FEM_SEVERAL_PIECES = 1 << 10,
    /// The body overlaps a shape without contact support, and does not collide with it: a btEmptyShape, a signed
    /// distance field that was not loaded, a mesh without its tree, a hull without points, a class that is neither a
    /// btConvexShape nor a btConcaveShape, or a user class whose processAllTriangles returns no triangle.
    BT_FEM_UNKNOWN_SHAPE = 1 << 11,
    /// There were more contact points than btFemSolverInfo::m_maxContacts; they were thinned by place.
    BT_FEM_CONTACT_LIMIT = 1 << 12,
    /// The body has a new factor from this step on: it is in contact or held while its step or masses differed from the
    /// factor's by a factor of 1.5 or its pins did, or btFemSolverInfo::m_refactoring requested it.
    BT_FEM_REFACTORED = 1 << 13,
    /// The other object of an anchor or joint left the world, and the anchor or joint was removed.
    BT_FEM_LOST_ANCHOR = 1 << 14,
    /// An anchor to a foreign node, or to a soft body that is not FEM, was ignored.
    BT_FEM_BAD_ANCHOR = 1 << 15,
    /// The stale factor has cost more iterations than a new one costs: call refactor().
    BT_FEM_REFACTOR_PAYS = 1 << 16,
    /// The interest was NaN and taken for 1, or was outside [0, 1] and clamped.
    BT_FEM_BAD_INTEREST = 1 << 17,
    /// Some nodes belong to no element: they stand still, or move to where the program writes m_x.
    BT_FEM_UNUSED_NODES = 1 << 18,
    /// Nodes or tetrahedra were appended, removed or connected otherwise: the body was set up anew in this step,
    /// without its targets and attachments.
    BT_FEM_CHANGED_MESH = 1 << 19,
    /// The embedded surface is unsuitable for collision, as BT_FEM_RENDER_SURFACE requests (see m_message): the
    /// boundary of the tetrahedra collides instead.
    BT_FEM_BAD_SURFACE = 1 << 20,
    /// The baked factor was not used, and a new one was made: the baked one exceeds the solver's memory limit, or the
    /// rest shape differs (scaled, or changed elements).
    BT_FEM_BAKED_UNUSED = 1 << 21,
    /// At the beginning of the step an object was deeper inside the body, or the body inside an object, than a
    /// hundredth of the body's size (the cube root of its volume), or the middle of a solid object was inside the body,
    /// which then never sleeps: it started there, or is crushed. Take a stiffer material, a finer mesh or smaller
    /// steps.
    BT_FEM_PENETRATING = 1 << 22,
    /// Some elements are inverted, or were within the last 32 steps: the body is crushed or twisted beyond the range of
    /// its elements, and its shape at rest may not be an equilibrium of its material. Take a stiffer material, a
    /// coarser mesh, lighter loads or smaller steps.
    BT_FEM_INSIDE_OUT = 1 << 23,
    /// Some elements are slivers: their volume is below a thousandth of their longest edge cubed (a regular tetrahedron
    /// has .118). They cost iterations, and the solve may miss its tolerance. Take a better mesh, or a cage.
    BT_FEM_SLIVERS = 1 << 24,
    /// btFemConstraintSolver solved the body after Bullet's rigid solver (staggered), as without that solver: a body of
    /// its group is joined to an object that Bullet did not pass in that call, because it sleeps or there are more
    /// contacts than btContactSolverInfo::m_minimumSolverBatchSize, or to a multibody's link.
    BT_FEM_SOLVED_AFTER = 1 << 25,
    /// The body should split (see btFemFracture), but could not (see m_message). It lost its strength and stays whole:
    /// allow larger factors, take a coarser mesh, and set the strength again.
    BT_FEM_NOT_SPLIT = 1 << 26,
    /// The body is too soft for its own weight: rho g H exceeds E / 2 with Hooke's law or an orthotropic one, which
    /// collapse there, so that the body sinks into itself and through its support. Take the Neo-Hookean law
    /// (btFemMaterial::m_law), a larger Young's modulus, or a smaller or lighter body (docs/manual.md, How stiff must
    /// my body be). H is the extent along gravity of the rest shape's largest connected component as the body lies; rho
    /// is its mass over its volume; pins are ignored. E is the harmonic mean over the volume, for relaxing materials
    /// with the long-time modulus; Neo-Hookean regions count as rigid. Never set without gravity. Checked when the body
    /// becomes FEM, and when its material, rest shape, mass or gravity changes.
    BT_FEM_TOO_SOFT = 1 << 27,
    /// The step would have created more energy than the body had and was given: elements turned or were
    /// crushed too far within it. Its elastic motion was shortened (docs/theory.md, Energy), and momenta stay. Take
    /// smaller steps or a softer material; where other flags are set, mend their causes first.
    BT_FEM_ENERGY = 1 << 28,
    /// A constraint of Bullet in the body's island was left out, as it is not finite or has a lower limit above the
    /// upper one, or its constraint force mixing is negative and counts as 0. Mend the values that were written to a
    /// joint or a contact point.
    BT_FEM_BAD_CONSTRAINT = 1 << 29
};

/// Report of a body's last step. Every field is written in every step; all are zero for a body that is not FEM.
struct btFemStepReport
{
    int m_flags = 0;  ///< btFemFlags
    /// Reason of a rejection, of a missing new factor, or of a refused surface; owned by the solver, valid until the
    /// body is removed.
    const char* m_message = "";
    btFemDetail m_detail = btFemDetail::nodalWarp;  ///< detail of its free motion; never automatic
    int m_nodes = 0;                                ///< nodes of its mesh
    int m_tets = 0;                                 ///< tetrahedra of its mesh
    int m_iterations = 0;                           ///< conjugate gradient iterations of the free motion, >= 0
    btScalar m_residual = 0;  ///< true relative residual |b - A dv| / |b| of the free motion [-], >= 0: see SolveReport
    /// Conjugate gradient iterations of the corrective solves after contact, for all bodies of its contact group.
    int m_contactIterations = 0;
    /// Sweeps over the group's contacts and joints, in all outer iterations and for position correction.
    int m_contactSweeps = 0;
    int m_contacts = 0;  ///< contact points
    /// Largest speed at which a contact point still closes faster than its gap allows [m/s], >= 0.
    btScalar m_contactViolation = 0;
    btScalar m_deepestPenetration = 0;  ///< deepest penetration at the start of the step [m], >= 0
    /// Stress of the wave that the hardest impact of the step starts [Pa], >= 0: rho c v with the speed v of approach,
    /// v Z Z' / (Z + Z') of two soft bodies with Z = rho c; 0 without impact. Elements have less stress in steps
    /// in which the wave crosses the body (docs/theory.md, Stress).
    btScalar m_impactStress = 0;
    long m_factorEntries = 0;            ///< entries of the full factor, fill included
    btScalar m_factorMegabytes = 0;      ///< memory of its factor [MB, 1e6 bytes]
    btScalar m_fullFactorMegabytes = 0;  ///< memory of the full factor, whether it has it or not [MB]
    bool m_lowMemory = false;            ///< its factor is the low-memory one
    btScalar m_factorSeconds = 0;        ///< wall time of its factorization [s]; 0 for a baked factor
    bool m_bakedFactor = false;          ///< its factor was read from a file, see btFemSoftBodySolver::useBaked
    btScalar m_freeMotionMs = 0;  ///< wall time of forces, rotations and the free solve [ms]; an equal share of a batch
    btScalar m_contactMs = 0;     ///< wall time of contacts and joints of all bodies of its contact group [ms]
    /// m_freeMotionMs + m_contactMs exceeded the step persistently, in at least ten more of the recent steps than not:
    /// the body, or its contact group, is too large for real time. Use coarser meshes, less detail or more threads.
    /// Depends on the clock, and is therefore no bit of m_flags, which are deterministic.
    bool m_tooSlow = false;
};

/// A contact point of the last step.
struct btFemContact
{
    /// Position on the soft surface at the start of the step, world [m]; between soft bodies the midpoint of both
    /// surfaces.
    btVector3 m_point;
    btVector3 m_normal;  ///< unit normal [-], from the other body to this one
    /// Signed distance at the start of the step [m]; negative inside. For a rotating kinematic object, reduced by the
    /// part of its arc that its velocity does not cover.
    btScalar m_gap = 0;
    btVector3 m_impulse;  ///< impulse on this body, normal and friction [N s]; the other body gets the opposite
    btScalar m_normalImpulse = 0;  ///< component of m_impulse along m_normal [N s], >= 0
    btVector3 m_frictionImpulse;   ///< tangential component of m_impulse [N s]
    /// The other object; the body itself for self contact. May be deleted by now: compare the pointer, never
    /// dereference it.
    const btCollisionObject* m_other = nullptr;
    /// Part of a mesh, by Bullet's numbering; for a height field 2 column (+ 1 for a cell's second triangle); -1 for
    /// other shapes and soft bodies.
    int m_part = -1;
    /// Triangle of the part, by Bullet's numbering; for a height field the row; -1 for other shapes and soft bodies.
    int m_index = -1;
    /// Maximum number of nodes of a contact point: those of up to three tetrahedra, with a collision surface embedded
    /// in them; a boundary triangle has three.
    static constexpr int kMaxNodes = 12;
    [[deprecated("kMaxNodes")]] static constexpr int kMostNodes = kMaxNodes;
    int m_nodes[kMaxNodes] = {0};  ///< nodes of this body whose weighted mean is the point; the first three may repeat
    btScalar m_weights[kMaxNodes] = {1};  ///< weights [-], sum 1; 0 for repeated nodes
    int m_nodeCount = 3;                  ///< number of nodes, in [1, kMaxNodes]
};

/// A stress in the world's axes [Pa], tension positive.
struct BULLETFEM_API btFemStress
{
    btScalar m_xx = 0;  ///< normal [Pa]
    btScalar m_yy = 0;  ///< normal [Pa]
    btScalar m_zz = 0;  ///< normal [Pa]
    btScalar m_xy = 0;  ///< shear [Pa]
    btScalar m_yz = 0;  ///< shear [Pa]
    btScalar m_xz = 0;  ///< shear [Pa]

    /// Von Mises equivalent stress [Pa], >= 0: the magnitude of a uniaxial stress, 0 for hydrostatic pressure.
    btScalar vonMises() const;
};

/// State of a contact pair.
enum class btFemTouchState
{
    began,    ///< began in the last step
    lasting,  ///< continues from an earlier step
    ended     ///< ended in the last step; reported once
};

/// A contact pair of the last step: a body and an object. The contact begins with a point that carries an impulse or
/// has no gap, and lasts until no point carries an impulse and all gaps exceed a hundredth of the body's mean edge
/// length, so that resting contacts do not flicker. It ends when the object leaves the world or is deleted.
struct btFemTouch
{
    /// The other object; the body itself for self contact. May be deleted once the contact has ended: compare the
    /// pointer, never dereference it.
    const btCollisionObject* m_other = nullptr;
    /// m_uniqueId of the object's broadphase proxy, which tells a new object at a reused address apart.
    int m_otherId = -1;
    btFemTouchState m_state = btFemTouchState::began;  ///< state of the contact
    int m_points = 0;                                  ///< number of contact points; 0 once it has ended
    btVector3 m_impulse{0, 0, 0};                      ///< sum of the impulses on this body [N s]
    /// Sum of the normal impulses [N s], >= 0; opposite impulses of a grip do not cancel.
    btScalar m_normalImpulse = 0;
};

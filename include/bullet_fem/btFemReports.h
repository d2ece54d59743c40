// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include "LinearMath/btVector3.h"
#include "bullet_fem/btFemPrecision.h"
#include "bullet_fem/fem/common/export.h"

class btCollisionObject;

/// How much a body is worth: what its factor is turned with, and whether it is iterated to the tolerance. A body that
/// touches something is iterated all the same.
enum class btFemDetail
{
    nodalWarp,     ///< one rotation a node
    globalWarp,    ///< the body's one rotation, as in the paper; for nearly rigid bodies
    direct,        ///< globalWarp to a residual of 5 %: mostly one iteration, for bodies nobody looks at
    oneIteration,  ///< nodalWarp to a residual of 5 %: mostly one iteration, for bodies that few look at
    automatic      ///< by btFemSoftBodySolver::setInterest, nodalWarp without that; the default. Never in a report
};

/// What happened in a step, or to a body at set-up. Several may be set at once.
enum btFemFlags
{
    /// The solve reached the iteration limit before its tolerance. The result is usable; raise the limit or call
    /// refactor().
    BT_FEM_NOT_CONVERGED = 1 << 0,
    /// The system was singular to rounding, and the best iterate was kept. Check the masses and Young's modulus.
    BT_FEM_BREAKDOWN = 1 << 1,
    /// The factor was made for another step, other masses or other pins, which costs iterations. refactor() mends it.
    BT_FEM_STALE_FACTOR = 1 << 2,
    /// Some m_x or m_v was not finite, or beyond 1e6 m or m/s, and was put back; m_f or gravity that was not finite was
    /// dropped.
    BT_FEM_RESTORED = 1 << 3,
    /// An inverse mass was negative or NaN, and the node got its share of the volume; or infinite (setTotalMass by
    /// faces), and the mass of the body was shared out by volume.
    BT_FEM_BAD_MASS = 1 << 4,
    /// The step was not in [1e-6, 1] s, and the body stood still.
    BT_FEM_BAD_STEP = 1 << 5,
    /// The mesh or the material is unusable (see m_message), and Bullet steps the body.
    BT_FEM_REJECTED = 1 << 6,
    /// The world holds the body more than once. It is stepped once; remove it once.
    BT_FEM_ADDED_TWICE = 1 << 7,
    /// The body was added to a second world or solver, which steps it. Remove it from one.
    BT_FEM_OTHER_WORLD = 1 << 8,
    /// Elements of negative orientation were turned.
    BT_FEM_TURNED_TETS = 1 << 9,
    /// The mesh is not connected: every component moves on its own.
    BT_FEM_SEVERAL_PIECES = 1 << 10,
    /// The body overlaps a shape that cannot be asked for contacts, and does not touch it: a btEmptyShape, a signed
    /// distance field that was not loaded, a mesh without its tree, a hull without points, a class that is neither a
    /// btConvexShape nor a btConcaveShape, or one of yours whose processAllTriangles hands over no triangle.
    BT_FEM_UNKNOWN_SHAPE = 1 << 11,
    /// There were more contact points than the solver info allows, and the deepest were kept.
    BT_FEM_CONTACT_LIMIT = 1 << 12,
    /// The body has a new factor from this step on: it touches something or is held while its step or masses were 1.5
    /// times off, or btFemSolverInfo::m_refactoring asked for it.
    BT_FEM_REFACTORED = 1 << 13,
    /// The other end of an anchor or joint left the world, and the body lost it.
    BT_FEM_LOST_ANCHOR = 1 << 14,
    /// An anchor to a foreign node, or to a soft body that is not FEM, was ignored.
    BT_FEM_BAD_ANCHOR = 1 << 15,
    /// The stale factor has cost more iterations than a new one costs: call refactor().
    BT_FEM_REFACTOR_PAYS = 1 << 16,
    /// The interest was NaN and taken for 1, or was outside [0, 1] and clamped.
    BT_FEM_BAD_INTEREST = 1 << 17,
    /// Some nodes belong to no element: they stand still, or go where m_x is written.
    BT_FEM_UNUSED_NODES = 1 << 18,
    /// Nodes or tetrahedra were appended, removed or connected otherwise: the body was set up anew in this step,
    /// without its targets and attachments.
    BT_FEM_CHANGED_MESH = 1 << 19,
    /// The render surface cannot collide as BT_FEM_RENDER_SURFACE asks (see m_message): the boundary of the tetrahedra
    /// does.
    BT_FEM_BAD_SURFACE = 1 << 20,
    /// The baked factor was not used, and a new one made: it is larger than the solver's limit, or the rest shape is
    /// another (scaled, or its elements changed).
    BT_FEM_BAKED_UNUSED = 1 << 21,
    /// Something was deeper inside the body as the step began than a hundredth of its size (the cube root of its
    /// volume), or the body in something: it started there, or is crushed. Take a stiffer material, a finer mesh or
    /// smaller steps.
    BT_FEM_PENETRATING = 1 << 22,
    /// Some elements are inside out, or were within the last 32 steps: the body is crushed or twisted beyond what its
    /// elements can follow, and what rests so has not the shape that its material would give it. Take a stiffer
    /// material, a coarser mesh, lighter loads or smaller steps.
    BT_FEM_INSIDE_OUT = 1 << 23,
    /// Some elements are slivers: their volume is below a thousandth of their longest edge cubed (a regular one has
    /// .118). They cost iterations, and the solve may miss its tolerance. Take a better mesh, or a cage.
    BT_FEM_SLIVERS = 1 << 24,
    /// btFemConstraintSolver solved the body after Bullet's rigid solver, as without that line: one of the bodies
    /// solved with it is joined to something that Bullet did not hand over together with them, because it sleeps or
    /// there are more contacts than btContactSolverInfo::m_minimumSolverBatchSize, or to a multibody's link.
    BT_FEM_SOLVED_AFTER = 1 << 25,
    /// The body had to split (see btFemFracture), and could not (see m_message). It has no strength from then on and is
    /// whole: allow larger factors, take a coarser mesh, and set the strength again.
    BT_FEM_NOT_SPLIT = 1 << 26,
    /// The body is too soft for its own weight: rho g H exceeds E / 2 with Hooke's law or an orthotropic one, which
    /// give way there, so that the body sinks into itself and through what it lies on. Take the Neo-Hookean law
    /// (btFemMaterial::m_law), a larger Young's modulus, or a smaller or lighter body (docs/manual.md, How stiff must
    /// my body be). H is the extent of the rest shape along gravity as the body lies, of its largest connected part;
    /// rho its mass over its volume; pins are not looked at. E is the harmonic mean over the volume, that of slow loads
    /// where the material relaxes; Neo-Hookean regions count as rigid. Without gravity it is not set. It is looked at
    /// as the body becomes FEM, and as its material, rest shape, mass or gravity changes.
    BT_FEM_TOO_SOFT = 1 << 27
};

/// What the last step did to a body. Every field is written in every step; all zero for a body that is not FEM.
struct btFemStepReport
{
    int m_flags = 0;             ///< btFemFlags
    const char* m_message = "";  ///< why the body was rejected, its factor not made anew, or its surface not taken;
                                 ///< owned by the solver, valid until the body is removed
    btFemDetail m_detail = btFemDetail::nodalWarp;  ///< what its free motion was solved with; never automatic
    int m_nodes = 0;                                ///< of its mesh
    int m_tets = 0;                                 ///< of its mesh
    int m_iterations = 0;                           ///< conjugate gradient iterations of the free motion, >= 0
    btScalar m_residual = 0;                        ///< its true |b - A dv| / |b| [-], >= 0: see SolveReport
    int m_contactIterations = 0;  ///< of the corrective solves after contact, of all bodies of its contact group
    int m_contactSweeps = 0;      ///< sweeps over that group's contacts and joints, in all rounds and
                                  ///< for position correction
    int m_contacts = 0;           ///< contact points
    btScalar m_contactViolation =
        0;  ///< largest speed at which a point still closes faster than its gap allows [m/s], >= 0
    btScalar m_deepestPenetration = 0;   ///< at the start of the step [m], >= 0
    long m_factorEntries = 0;            ///< entries of the full factor, fill included
    btScalar m_factorMegabytes = 0;      ///< memory of the factor that it has [MB, 1e6 bytes]
    btScalar m_fullFactorMegabytes = 0;  ///< of the full one, which it has or would have had [MB]
    bool m_lowMemory = false;            ///< its factor is the low-memory one
    btScalar m_factorSeconds = 0;        ///< wall time that factoring took, when it was made [s]; 0 if it was baked
    bool m_bakedFactor = false;          ///< its factor was read from a file, see btFemSoftBodySolver::useBaked
    btScalar m_freeMotionMs = 0;  ///< wall time of forces, rotations and the free solve [ms]; an equal share of a batch
    btScalar m_contactMs = 0;     ///< wall time of contacts and joints of all bodies of its contact group [ms]
    /// The sum of both has been longer than the step, in more of the last steps than not: the body, or what it touches,
    /// is too big for real time. Use coarser meshes, less detail or more threads. By the clock, so not one of the
    /// flags, which are the same in every run.
    bool m_tooSlow = false;
};

/// A contact point of the last step.
struct btFemContact
{
    btVector3 m_point;             ///< on the soft surface at the start of the step, world [m]; between soft bodies the
                                   ///< middle of both surfaces
    btVector3 m_normal;            ///< unit [-], from the other body to this one
    btScalar m_gap = 0;            ///< signed distance at the start of the step [m]; negative inside. Of a kinematic
                                   ///< object that turns, less what its arc closes beyond its velocity
    btVector3 m_impulse;           ///< on this body: normal and friction [N s]; the other body got the opposite
    btScalar m_normalImpulse = 0;  ///< its part along m_normal [N s], >= 0
    btVector3 m_frictionImpulse;   ///< its other part, in the tangent plane [N s]
    const btCollisionObject* m_other = nullptr;  ///< the body itself for self contact; deleted since, it is one to
                                                 ///< compare, never to follow
    int m_part = -1;   ///< part of a mesh, as Bullet numbers them; of a height field 2 column (+ 1 for a cell's second
                       ///< triangle); -1 for other shapes and soft bodies
    int m_index = -1;  ///< likewise its triangle; of a height field the row
    /// Nodes that may carry a point: those of a triangle, or of up to three tetrahedra where the surface that follows
    /// them collides.
    static constexpr int kMaxNodes = 12;
    [[deprecated("kMaxNodes")]] static constexpr int kMostNodes = kMaxNodes;
    int m_nodes[kMaxNodes] = {0};         ///< nodes of this body that carry the point; among the first 3 they repeat
    btScalar m_weights[kMaxNodes] = {1};  ///< [-], sum 1; 0 for those that repeat
    int m_nodeCount = 3;                  ///< how many they are, in [1, kMaxNodes]
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

    /// Von Mises' equivalent stress [Pa], >= 0: in uniaxial stress its magnitude, under pressure from all sides 0.
    btScalar vonMises() const;
};

/// Where a touch stands.
enum class btFemTouchState
{
    began,    ///< in the last step
    lasting,  ///< it began before
    ended     ///< the last step found none; told once
};

/// A body and an object that it touches, in the last step. A touch begins with a point that carries an impulse or has
/// no gap, and lasts until no point carries an impulse and all gaps exceed a hundredth of the body's mean edge, so that
/// bodies at rest do not flicker. An object that left the world, or was deleted, is touched no more.
struct btFemTouch
{
    const btCollisionObject* m_other = nullptr;  ///< the body itself for self contact; once the touch has ended it may
                                                 ///< be deleted: compare it, never follow it
    int m_otherId = -1;  ///< its m_uniqueId in the broadphase: another object at the same address has another
    btFemTouchState m_state = btFemTouchState::began;  ///< where it stands
    int m_points = 0;                                  ///< contact points that touch; 0 once it has ended
    btVector3 m_impulse{0, 0, 0};                      ///< sum over them, on this body [N s]
    btScalar m_normalImpulse = 0;  ///< sum of their normal impulses [N s], >= 0; those of a grip do not cancel
};

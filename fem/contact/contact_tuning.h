// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <cstddef>

// Values of the contact solver that no formula gives. Bounds of rounding, sizes of memory and lanes are where they are
// used. "Loses": what was measured without the rule, in tests or in bulletfem_bench_games.
namespace bullet_fem
{

// --- Outer iterations ---

// Residuals of corrective solves are limited to a share of the contact tolerance, or to kJointTolerance [-]; after the
// usual number of outer iterations, in each further one to that share of the last limit. Loses: twice the conjugate
// gradient iterations of a pit with the finest limit everywhere; PinchFriction takes 1.8 times as long, and sinks twice
// as deep, if further iterations are no more accurate.
inline constexpr double kResidualShare = 0.3;
inline constexpr int kUsualRounds = 3;

// The tolerance of a fast impact is a share of a high speed: the error must not let thin and tiny bodies penetrate
// deeply within the step. Share of an element's edge per step [-]. Loses: a pit closes at 14 mm/s for 6.
inline constexpr double kErrorOfEdge = 5e-4;

// Every step reduces the error of the warm start by this factor, to the tolerance at least: errors of resting contacts,
// which are passed on from step to step, vanish within a few. A much better warm start needs no outer iteration: bounds
// as a share of the tolerance, and of the scale [-]. Loses: bodies creep on slopes (Sticking, InclineTest, CubeAtRest).
inline constexpr double kForcing = 0.1;
inline constexpr double kRestShare = 0.01;
inline constexpr double kFinestRest = 3e-6;

// A warm start is rejected if it makes points approach or separate this many times faster than without it [-]. Points
// of movable rigid proxies are excluded: their other contacts, which have no warm start, may balance it.
inline constexpr double kBadGuess = 5;

// If an outer iteration leaves more than this share of a small error, the error is that of the corrective solves, or of
// sliding points that pass load on gradually, which the next step corrects. If W is too soft, every outer iteration
// removes only a part. Impacts may take several iterations without visible progress [-]. Sweeps stand still as well if
// the best change of a window of them is more than this share of the last window's: if constraints are incompatible, as
// for some sliding points, an impulse grows by a constant amount in every sweep while no velocity changes. Loses: a
// quarter more sweeps in PinchFriction.
inline constexpr double kStandstill = 0.8, kSmallError = 5e-3;
inline constexpr int kWindow = 10;

// Joints: share of the impulses on their bodies that may be missing, and of the speed scale that their sides may miss;
// remaining share that is reported as not converged [-].
inline constexpr double kJointTolerance = 1e-3;
inline constexpr double kUnsolvedJoints = 0.05;

// --- The compliance W ---

// W may be too stiff by a factor below 2 for outer iterations to converge; it is then scaled, with a margin for
// directions without impulses, and a share of the scale is kept for the next step [-]. W that is too soft by the same
// factor keeps outer iterations from standing still. Loses: a body with a factor of a sixteenth of its mass
// (StaleFactorContact), StaleContact.
inline constexpr double kMaxMisfit = 1.5, kScaleMargin = 1.2, kForgetting = 0.99;
// Steps in which W of a body with contacts and joints is that of the present A, after a larger misfit; maximum product
// of its nodes and elements, some 5 ms. Loses: beams that are thrown (HardPressedBeam).
inline constexpr int kPresentSteps = 20;
inline constexpr std::size_t kMaxPresentWork = 10'000;

// --- Sweeps ---

// Weights of nearly parallel differences are large and opposite, and dominated by rounding: maximum trusted weight [-].
// Loses: Runaway.IsRevertedForAMixOfSweeps, where no impulse suffices.
inline constexpr double kMaxMixingWeight = 300;

// A pair of owners is swept again, at most this often, if it has just changed by more than this share of the speed
// scale and by more than the tolerance: smaller errors are between pairs. Loses: a third to half more sweeps in pits.
inline constexpr double kResweepError = 5e-3;
inline constexpr int kMaxResweeps = 8;

// A row that requires less than this share of the tolerance waits until it requires more, or until sweeps are to end
// [-]. With a larger share, piles would creep. Loses: PlankBetweenCushions does not converge in some steps.
inline constexpr double kNegligible = 0.1;

// Lifetime of a working set in sweeps, and after a share of its rows has just joined it. Loses: 10 to 50 % of the time
// of pits and jams without working sets; without the short life jams take 10 to 50 % longer, light boxes 3 to 12 %
// more sweeps.
inline constexpr int kWorkingSetSweeps = 10, kShortLife = 2;
inline constexpr double kJoinedShare = 0.02;

// Impacts change velocities by the speed scale, occasionally by some tens of it [-]; a sweep beyond this diverges.
inline constexpr double kRunaway = 1e3;

// Contacts between rigid proxies are settled for the warm start until a sweep changes less than this share of the
// largest change [-]. Loses: a quarter to two fifths more sweeps in pits.
inline constexpr double kTouchesSettled = 1e-3;
// Sweeps of theirs, and of the position correction, at most.
inline constexpr int kMaxOtherSweeps = 200;

// Friction may add this share of a rigid contact's normal impulse by its lever arm [-]; beyond it the load would have
// no bound [Painleve 1895], and led bodies with a friction coefficient of 10 stop dead.
inline constexpr double kMaxPressing = 0.9;

// --- Newton steps ---

// Sweeps before the first step, and from one step to the next that pays, twice as many after each that does not; share
// of the change that a sweep after a step that pays leaves at most [-]. Loses: a third more sweeps in pits and towers
// of light boxes; 200 kg on a cube of 1 kg.
inline constexpr int kMinInterval = 3;
inline constexpr double kPays = 0.4;
// More sweeps than a step costs: if they suffice at the present rate, as in most piles, there is no step.
inline constexpr int kSweepsPerStep = 100;
// Iterations of the first step, each as expensive as a sweep: twice as many after a step that pays, up to eight times,
// half as many after another, down to a half. Loses: Squeezed with this as minimum, RigidSlide with it and no maximum.
inline constexpr int kBudget = 24;

// --- Coarse level ---

// If the warm start leaves less than this share of the loads' speed, bodies are nearly at rest, and the error on the
// coarse level would tilt stacks; others would only need more sweeps for it [-]. Loses: towers of twenty cubes lean
// (SoftTower), and light boxes under heavy ones shift (CoupledStack).
inline constexpr double kCalmGuess = 2e-2;

// Maximum cost of the factor in multiplications. A tower of a hundred floors takes 20,000, fifty bodies in a pit a
// hundred million, where plain sweeps are as fast.
inline constexpr double kMaxCoarseWork = 1e6;

// --- Joints ---

// Maximum multiplications of one factor, some 20 ms and 8 MB; larger systems are solved in parts of this many joints,
// in turn.
inline constexpr double kMaxJointWork = 6e7;
inline constexpr int kJointsOfPart = 64;

// Maximum number of changes of the held set per step; each takes a new factor.
inline constexpr int kPatience = 30;

// Share of a residual that a factor of an earlier step's W may leave; if it leaves more, it is rejected [-]. Loses: a
// late frame of a block on 121 anchors takes 1.6 times as long with a thousandth of it.
inline constexpr double kMisleads = 0.1;

// Joints of a body whose factor is kept in its frame: fewer take less than 10 us.
inline constexpr int kMinHeldNodes = 24;

// --- Position correction ---

// Share of the speed scale at which sweeps end [-], at least; a tenth of the contact tolerance.
inline constexpr double kPushTolerance = 1e-4;

}  // namespace bullet_fem

// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "bullet_fem/fem/contact/contact_solver.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "fem/contact/contact_tuning.h"
#include "fem/contact/solver/gcr_iteration.h"
#include "fem/contact/solver/position_correction.h"

namespace bullet_fem
{

std::shared_ptr<ComplianceCache> makeComplianceCache(std::shared_ptr<const BodyModel> model, std::vector<int> nodes)
{
    return std::make_shared<ComplianceCache>(std::move(model), std::move(nodes));
}

std::shared_ptr<ComplianceCache> makeComplianceCache(std::shared_ptr<const BodyModel> model)
{
    return std::make_shared<ComplianceCache>(std::move(model));
}

void ContactProblem::clear()
{
    m_bodies.clear();
    m_rigidProxies.clear();
    m_responses.clear();
    m_contacts.clear();
    m_joints.clear();
    m_rigidContacts.clear();
    m_torsions.clear();
    m_jacobians.clear();
    m_torsionOf.clear();
    m_handleNodes.clear();
    m_handleBlocks.clear();
}

namespace
{

constexpr double kNoJointSpeed = 1e-6;      // share of the speed scale that is rounding [-]
constexpr double kRoundingOfOthers = 1e-6;  // rows of others may be solved in single precision [m/s]

// Progress of the sweeps of an outer iteration.
struct SweepProgress
{
    int m_sweeps = 0;
    double m_best = 0, m_bestBefore = 0;  // smallest changes, of this window and the last

    bool stalls(double change)
    {
        m_best = m_sweeps % kWindow == 0 ? change : std::min(m_best, change);
        if (++m_sweeps % kWindow != 0) return false;
        const bool stalled = m_sweeps > kWindow && m_best > kStandstill * m_bestBefore;
        m_bestBefore = m_best;
        return stalled;
    }
};

}  // namespace

struct ContactSolver::Scratch
{
    ContactRows m_rows;
    ContactSweeps m_sweeps{m_rows};
    GcrIteration m_gcr{m_rows, m_sweeps.joints()};
    PositionCorrection m_push{m_rows, m_sweeps};
    ContactProblem* m_problem = nullptr;
    ContactSettings m_settings;
    ContactReport m_report;
    RowSurvey m_found;         // after the last outer iteration
    double m_error = 1;        // errorNow() after the last outer iteration
    double m_left = 0;         // speedLeft() after the last outer iteration
    double m_best = 0;         // minimum of m_left so far
    bool m_isBest = false;     // the last outer iteration is the best
    bool m_holdsSoft = false;  // joints hold soft bodies
    bool m_isCalm = false;     // the warm start was accurate
    double m_goal = 0;         // error at which outer iterations end
    double m_floor = 0;        // share of a body's impulses that residuals are measured against
    SweepProgress m_progress;
    bool m_stalled = false;
    bool m_othersMoved = false;  // rows of others changed velocities in this outer iteration
    bool m_begins = false;       // no sweep has been made since the bodies' true velocities were measured
    bool m_empty = true;
    bool m_isAlone = false;  // there are no rows of a caller

    bool settleRigid();
};

// Solves what moves rigid bodies alone for the warm start of the rest: joints have none, and without them the first
// sweep would undo that of the contacts. True if there is any.
bool ContactSolver::Scratch::settleRigid()
{
    const bool joints = !m_problem->m_joints.empty() && !m_holdsSoft;
    if (joints) m_sweeps.joints().solve();
    const bool contacts = m_rows.settleRigidContacts();
    if (joints && contacts) m_sweeps.joints().solve();
    if (joints) m_gcr.look(true);
    return joints || contacts;
}

double residualFloor(double contactTolerance, double solveTolerance)
{
    return std::clamp(kResidualShare * contactTolerance / solveTolerance, kJointTolerance, 1.0);
}

ContactSolver::ContactSolver() : m_scratch(std::make_unique<Scratch>()) {}
ContactSolver::~ContactSolver() = default;

ContactReport ContactSolver::solve(ContactProblem& problem, const ContactSettings& settings)
{
    begin(problem, settings);
    m_scratch->m_isAlone = true;
    while (needsOuterIteration())
    {
        for (int s = 0; s < settings.m_sweeps && sweep();) ++s;
        correct();
    }
    if (shouldRollBack()) restoreBest();
    return finish();
}

void ContactSolver::begin(ContactProblem& problem, const ContactSettings& settings)
{
    Scratch& s = *m_scratch;
    s.m_problem = &problem;
    s.m_settings = settings;
    s.m_report = {};
    s.m_isBest = s.m_isAlone = false;
    s.m_report.m_contacts = static_cast<int>(problem.m_contacts.size());
    const auto expects = [](const ContactBody& body) { return body.m_predicted != nullptr; };
    const bool anyExpects = std::any_of(problem.m_bodies.begin(), problem.m_bodies.end(), expects);
    s.m_empty = problem.m_contacts.empty() && problem.m_joints.empty() && !anyExpects;
    for (RigidProxy& rigidProxy : problem.m_rigidProxies)
        rigidProxy.m_pushLinear = rigidProxy.m_pushAngular = rigidProxy.m_angularImpulse = rigidProxy.m_pushImpulse =
            rigidProxy.m_pushAngularImpulse = rigidProxy.m_accumulatedImpulse =
                rigidProxy.m_accumulatedAngularImpulse = {};
    if (s.m_empty) return;
    const bool joints = !problem.m_joints.empty();
    const auto holdsSoft = [](const Joint& joint) { return joint.m_a.m_body >= 0 || joint.m_b.m_body >= 0; };
    s.m_holdsSoft = std::any_of(problem.m_joints.begin(), problem.m_joints.end(), holdsSoft);
    s.m_floor = s.m_holdsSoft ? kJointTolerance : residualFloor(settings.m_tolerance, settings.m_step.m_tolerance);
    s.m_rows.assemble(problem, settings, s.m_floor);
    s.m_sweeps.begin();
    s.m_gcr.begin();
    s.m_push.begin();
    s.m_error = 1;
    s.m_isCalm = false;
    s.m_progress = {};
    s.m_stalled = s.m_othersMoved = false;
    const double missing = s.m_rows.missingSpeed();
    s.m_rows.setSpeedScale(missing);
    // The warm start is first tested on the true system, so that W serves only for the difference.
    const bool guesses = anyExpects || s.m_rows.hasImpulses();
    if (guesses)
        guess();
    else
    {
        s.m_rows.warmStart();
        s.m_sweeps.measure();
        s.m_gcr.look();
    }
    if (s.settleRigid() || !guesses) s.m_found = s.m_sweeps.look();
    // A warm start that is balanced up to one per cent may leave a stiff body a thousand times the missing speed.
    s.m_rows.setSpeedScale(std::min(missing, std::max(s.m_found.m_wanted, s.m_gcr.largestSpeed())));
    const double shareOfEdge = s.m_rows.share(kErrorOfEdge * s.m_rows.shortestEdge() / settings.m_step.m_step);
    s.m_settings.m_tolerance = std::min(settings.m_tolerance, std::max(shareOfEdge, kFinestRest));
    s.m_error = errorNow();
    s.m_goal = std::max(kRestShare * s.m_settings.m_tolerance, std::min(s.m_settings.m_tolerance, kFinestRest));
    s.m_settings.m_tolerance = std::clamp(kForcing * s.m_error, s.m_goal, s.m_settings.m_tolerance);
    if (!s.m_holdsSoft) s.m_floor = residualFloor(s.m_settings.m_tolerance, settings.m_step.m_tolerance);
    s.m_isCalm = std::max(s.m_found.m_wanted, s.m_gcr.largestSpeed()) < kCalmGuess * s.m_rows.loadSpeed();
    s.m_best = std::numeric_limits<double>::infinity();
    if (guesses || !joints) noteBest();  // zero impulses of joints are no acceptable solution
}

// Error relative to the speed scale; the error of joints is rescaled to the tolerance of contacts.
double ContactSolver::errorNow() const
{
    const Scratch& s = *m_scratch;
    return std::max(s.m_rows.share(s.m_found.m_wanted), s.m_settings.m_tolerance / kJointTolerance * errorOfJoints());
}

// Remaining speed relative to the scale, with joints weighted like contacts: in errorNow() their share vanishes if the
// scale is a high speed, and an outer iteration that leaves a node a hundred times as fast could count as the best.
double ContactSolver::speedLeft() const
{
    const Scratch& s = *m_scratch;
    return s.m_rows.share(std::max(s.m_found.m_wanted, s.m_gcr.largestSpeed()));
}

double ContactSolver::errorOfJoints() const
{
    const Scratch& s = *m_scratch;
    return std::max(s.m_gcr.largestShare(kNoJointSpeed * s.m_rows.speedScale()),
                    s.m_rows.share(s.m_gcr.largestSpeed()));
}

// Applies the warm start, and rejects it if it is bad even after sweeps, which balance large forces on a stiff body: in
// a jam it may be meaningless, and would set the scale of this step's errors and the next warm start.
void ContactSolver::guess()
{
    Scratch& s = *m_scratch;
    const double without = s.m_rows.speedScale();
    s.m_rows.warmStart();
    correct(true);
    const auto isBad = [&] { return std::max(s.m_found.m_closing, s.m_found.m_guessed) > kBadGuess * without; };
    if (!isBad()) return;
    for (int k = 0; k < s.m_settings.m_sweeps && sweep();) ++k;
    correct();
    if (!isBad()) return;
    s.m_rows.takeBack();
    s.m_error = 0;  // accurate solve
    correct();
    s.m_stalled = false;
}

// If W is far from the true response, as in a jam of strained bodies, an outer iteration may increase the error.
void ContactSolver::noteBest()
{
    Scratch& s = *m_scratch;
    s.m_left = speedLeft();
    s.m_isBest = s.m_left <= s.m_best;
    if (!s.m_isBest) return;
    s.m_best = s.m_left;
    s.m_rows.keep();
}

bool ContactSolver::isBest() const
{
    return m_scratch->m_isBest;
}

// A step never ends with impulses that leave more speed than at its beginning, a relative error of some 1, if an
// earlier outer iteration left less: jams of overlapping cubes would be thrown apart.
bool ContactSolver::shouldRollBack() const
{
    const Scratch& s = *m_scratch;
    return !s.m_empty && !s.m_isBest && s.m_left > 1;
}

void ContactSolver::restoreBest()
{
    Scratch& s = *m_scratch;
    if (!shouldRollBack()) return;
    s.m_rows.restoreBest();
    s.m_error = 0;  // accurate solve
    correct();
}

bool ContactSolver::needsOuterIteration() const
{
    const Scratch& s = *m_scratch;
    if (s.m_empty) return false;
    const int rounds = s.m_report.m_rounds;
    return rounds < s.m_settings.m_rounds ||
           (rounds < s.m_settings.m_maxRounds && s.m_error > s.m_goal && !s.m_stalled);
}

bool ContactSolver::sweep(double others)
{
    Scratch& s = *m_scratch;
    if (s.m_empty) return false;
    ++s.m_report.m_sweeps;
    if (s.m_begins && s.m_holdsSoft) s.m_gcr.combine();
    s.m_begins = false;
    const double tolerance = s.m_settings.m_tolerance;
    const double othersChange = s.m_rows.share(others);
    const bool othersMove = others > kRoundingOfOthers && othersChange > tolerance;
    if (othersMove) s.m_sweeps.othersMoved();
    s.m_othersMoved = s.m_othersMoved || othersMove;
    const bool moves = s.m_sweeps.sweep(tolerance);
    if (s.m_sweeps.runsAway())
    {
        s.m_sweeps.letGo();
        s.m_report.m_converged = false;
        return true;
    }
    if (!moves && !othersMove) return false;
    return !s.m_progress.stalls(std::max(s.m_sweeps.lastChange(), othersChange));
}

void ContactSolver::correct()
{
    correct(false);
}

void ContactSolver::correct(bool steady)
{
    Scratch& s = *m_scratch;
    if (s.m_empty) return;
    ++s.m_report.m_rounds;
    s.m_progress = {};
    if (s.m_isCalm) s.m_sweeps.end();
    if (s.m_report.m_rounds > kUsualRounds) s.m_floor = std::max(kResidualShare * s.m_floor, kJointTolerance);
    if (s.m_rows.apply(s.m_floor, steady, s.m_report)) s.m_sweeps.joints().reform();
    s.m_sweeps.measure();
    s.m_gcr.look(s.m_othersMoved);
    s.m_othersMoved = false;
    s.m_begins = true;
    const double before = s.m_error;
    s.m_found = s.m_sweeps.look();
    s.m_error = errorNow();
    s.m_goal = s.m_settings.m_tolerance;
    s.m_stalled = s.m_isAlone && s.m_report.m_rounds > s.m_settings.m_rounds + 1 && !s.m_rows.isTooSoft() &&
                  s.m_error > kStandstill * before && s.m_error < kSmallError && errorOfJoints() <= kJointTolerance;
    noteBest();
}

ContactReport ContactSolver::finish()
{
    Scratch& s = *m_scratch;
    if (s.m_empty) return s.m_report;
    if (s.m_begins && s.m_holdsSoft && errorOfJoints() > kJointTolerance && s.m_gcr.isBestBehind())
    {
        s.m_gcr.takeBest();
        correct();
        restoreBest();  // the residual predicted by GCR assumed other contact impulses
    }
    s.m_report.m_converged = s.m_report.m_converged && errorOfJoints() <= kUnsolvedJoints;
    s.m_report.m_violation = s.m_rows.store();
    s.m_rows.noteReactions();
    if (s.m_push.isNeeded()) s.m_report.m_sweeps += s.m_push.push();
    return s.m_report;
}

}  // namespace bullet_fem

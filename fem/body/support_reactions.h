// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <vector>

#include "bullet_fem/fem/body/body_state.h"
#include "bullet_fem/fem/body/node_reaction.h"

namespace bullet_fem
{

/// Notes what a step does to a body with fixed nodes, from which the forces on these are computed afterwards. The rows
/// of the step's equation at the fixed nodes p give the distribution of the forces,
///
///     h R_p = m_p (v* - v)_p + ((A - M)(v* - v0 + d (c - e)))_p - b_p - J_p
///
/// with the change c that the step does not resolve, its resolved part c - e (smoothing.h), and v0 the velocities that
/// b belongs to. Residuals at the free nodes, and terms nonlinear in positions, make the sums of R_p differ slightly
/// from the body's true change of momentum: the difference is distributed over the fixed nodes like the momentum of a
/// rigid motion of their masses.
class SupportReactions
{
public:
    /// Makes room where the model has fixed nodes.
    explicit SupportReactions(const BodyModel& model);

    /// How the step is made.
    struct Step
    {
        double m_length = 0;   ///< h [s]
        double m_damping = 0;  ///< alpha, of the material and of the loads [1/s]
        double m_toFrame = 0;  ///< StepLoads::m_frameDamping [1/s]
    };

    /// As a step begins, of a body of this model. Grows where it has fixed nodes for the first time.
    void begin(const BodyModel& model, const BodyState& state, const Step& step);

    /// True in a step of a body with fixed nodes; else nothing that follows is to be called, unless it says so.
    bool isNoting() const { return m_stage == Stage::step; }

    /// The velocities that the linear system starts from [m/s]; of any body.
    void noteKick(const std::vector<Vec3>& velocity);

    /// b of the linear system, with all rows [kg m/s].
    void noteRightSide(const std::vector<Vec3>& b);

    /// In place of b where quasi-Newton iterations have found forces [N] at their last positions: the loads are [N s].
    void noteForces(const std::vector<Vec3>& loads, const std::vector<Vec3>& force);
    /// The velocities that those iterations end with, which are v0 then; of any body [m/s].
    void noteSolved(const std::vector<Vec3>& velocity);

    /// Adds impulses to b_p, one per node [N s].
    void add(const std::vector<Vec3>& impulses);

    /// Impulses of contact and joints on a component of the mesh [N s], about the origin [N m s]. They are in add(),
    /// too.
    void addOutside(int component, const Vec3& impulse, const Vec3& angularImpulse);

    /// Changes of velocities from outside after begin() [m/s]; of any body.
    void changeVelocity(const std::vector<Vec3>& change);

    /// As the step ends: the change c [m/s], if some of it is not resolved.
    void noteChange(const std::vector<Vec3>& change) { m_change = change, m_needsSmoothing = true; }
    /// With v*, before the unresolved part e [m/s] is taken from it d `share` times.
    void noteEnd(const std::vector<Vec3>& velocity, const std::vector<Vec3>& unresolved, double share);
    /// With the state at the end of the step.
    void finish(const BodyState& state);

    /// Nothing is known from now on; of any body.
    void forget() { m_stage = Stage::nothing; }

    /// True if the reactions of the last step are known, or can be found.
    bool isKnown(const BodyModel& model) const
    {
        return (m_stage == Stage::ended || m_stage == Stage::found) && m_model == &model;
    }
    bool isFound() const { return m_stage == Stage::found; }

    /// The vector that A is to be applied to, valid from noteEnd() on, and scratch for the product.
    const std::vector<Vec3>& change() const { return m_change; }
    std::vector<Vec3>& product() { return m_product; }
    /// Finds them from A change(), with the masses of A and the loads of the step.
    void find(const std::vector<double>& scaledMass, const StepLoads& loads);

    const std::vector<NodeReaction>& reactions() const { return m_reactions; }

private:
    enum class Stage
    {
        nothing,  // no fixed nodes, or not known
        step,
        ended,
        found  // m_reactions are those of the last step
    };
    struct Component
    {
        Vec3 m_origin;  // reference point of moments: centre of mass of the fixed nodes [m]
        // impulses of contact and joints, about the world's origin; then the imbalance, about m_origin [N s], [N m s]
        Vec3 m_linear, m_angular;
        double m_mass = 0, m_spread = 0;  // of all nodes [kg], and times their squared distances to m_origin [kg m2]
        double m_fixedMass = 0;           // of the fixed ones [kg]
        Mat3 m_inertia;                   // inertia of these about m_origin [kg m2]
        Vec3 m_shift, m_turn;             // rigid motion of these with the missing momentum [m/s], [rad/s]
    };
    void makeRoom(const BodyModel& model, std::size_t fixed);
    void findImpulses(const std::vector<double>& scaledMass);
    void centre(const std::vector<double>& scaledMass);
    void findMissing(const std::vector<double>& scaledMass, const StepLoads& loads);
    void shareOutMissing(const std::vector<double>& scaledMass);
    Component& componentOf(std::size_t node) { return m_components[m_model->mesh().nodeComponent()[node]]; }
    Vec3 middle(std::size_t node) const { return 0.5 * (m_beginPosition[node] + m_endPosition[node]); }

    Stage m_stage = Stage::nothing;
    const BodyModel* m_model = nullptr;
    Step m_step;
    bool m_needsSmoothing = false;  // m_change is known
    bool m_isNewton = false;        // quasi-Newton iterations have changed m_from
    std::vector<Vec3> m_beginPosition, m_endPosition, m_beginVelocity, m_endVelocity;
    std::vector<Vec3> m_from;            // velocities that the system of the reactions starts from
    std::vector<Vec3> m_solvedVelocity;  // v*, where there is damping by mass or to a frame
    std::vector<Vec3> m_change;          // c; once the step has ended, the vector to which A - M is applied
    std::vector<Vec3> m_product;
    std::vector<Vec3> m_known;  // b_p + J_p, of the fixed nodes
    std::vector<Component> m_components;
    std::vector<NodeReaction> m_reactions;
};

}  // namespace bullet_fem

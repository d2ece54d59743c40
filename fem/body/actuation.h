// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <vector>

#include "bullet_fem/fem/body/actuators.h"
#include "fem/body/conjugate_gradients.h"

namespace bullet_fem
{

/// Coefficients of an actuator's force in a step of h (StepCoefficients): see Actuation.
struct PullFactors
{
    double m_step = 0;        ///< h [s]
    double m_ofVelocity = 0;  ///< s h [s]
    double m_inMatrix = 0;    ///< c h^2 [s2]
};

/// A body's actuators in one step, linearized about the kick positions y. An actuator with the scalar q(x) and gradient
/// g = dq/dx applies to the nodes the force
///
///     Q g,   Q = Q(q(y)) - kappa (s h g . v + c h g . dv),   kappa = -dQ/dq >= 0
///
/// Q is the gauge pressure of a chamber, with kappa = p_absolute / V of a sealed gas, or minus the tension of a cable,
/// with kappa its stiffness. A gains the positive semidefinite rank-one matrix c h^2 kappa g g^T, in analogy to the
/// material's h^2 K', so a step is stable for any kappa. The preconditioner P is updated by the Woodbury formula, so
/// the number of conjugate gradient iterations does not depend on kappa. Cables add their tensile geometric stiffness,
/// tension / length (I - d d^T) for every straight segment of direction d, to T in A.
class Actuation
{
public:
    /// Linearizes at the positions y [m] and the velocities v [m/s] before the step. Allocates only when the number of
    /// triangles or points grows.
    void begin(const Actuators& actuators, const PullFactors& factors, const std::vector<Vec3>& y,
               const std::vector<Vec3>& v);

    double step() const { return m_factors.m_step; }  ///< h [s]

    /// Sets the explicit part of Q, from the velocities v [m/s], and adds it times g to the nodes' forces [N].
    void addForces(const Actuators& actuators, const std::vector<Vec3>& v, std::vector<Vec3>& force);

    /// b -= (actuators' part of A) in.
    void subtractFromRightSide(const Actuators& actuators, const std::vector<Vec3>& in, std::vector<Vec3>& b);

    /// out += (actuators' part of A) in.
    void addProduct(const Actuators& actuators, const std::vector<Vec3>& in, std::vector<Vec3>& out) const;

    /// out += g times the part of the right-hand side [N s] that cables had before they were let go.
    void addReleased(const Actuators& actuators, std::vector<Vec3>& out) const;

    /// True if any actuator of this step has a stiffness; only then the functions below are needed.
    bool isStiff() const { return !m_stiff.empty(); }

    /// Factors the Woodbury correction of a preconditioner of A without actuators: one application per stiff actuator.
    void factor(const Actuators& actuators, const LinearOperator& preconditioner);

    /// Turns P r of A without actuators into (P^-1 + sum c h^2 kappa g g^T)^-1 r. Requires factor().
    void correct(const Actuators& actuators, std::vector<Vec3>& Pr) const;

    /// Records that the right-hand side contains the stiff actuators' part of A times `in`, for lift().
    void setRightSide(const Actuators& actuators, const std::vector<Vec3>& in);

    /// The velocity increment that balances the stiff actuators' part of b, with the preconditioner in place of A^-1.
    /// The remaining b is of the size of the material's forces, whatever the stiffness.
    const std::vector<Vec3>& lift();

    /// Releases cables that would push if the free nodes' velocities change by dv: removes their part from b at free
    /// nodes and from A. Returns true if any was released; factor() is required then.
    bool releaseSlack(const Actuators& actuators, const std::vector<unsigned char>& fixed, const std::vector<Vec3>& dv,
                      std::vector<Vec3>& b);

    /// Approximate square of the norm of the actuators' node forces [N2], for the tolerance of the solve.
    double squaredForces(const Actuators& actuators) const;

private:
    struct Pull
    {
        std::vector<Vec3> m_gradient;  // chamber: gradient per triangle, for each of its nodes [m2]; cable: unit
                                       // direction of each straight segment [-]
        std::vector<double> m_slope;   // cable: c h^2 tension / length of each straight segment [kg]
        double m_force = 0;            // Q(q(y)) [Pa] or [N]
        double m_stiffness = 0;        // kappa [Pa/m3] or [N/m]
        double m_rightSide = 0;        // b contains this times g [Pa s] or [N s]
        bool m_pulls = true;           // false: slack cable
    };
    static void beginChamber(const Chamber& chamber, const std::vector<Vec3>& y, Pull& pull);
    void beginCable(const Cable& cable, const std::vector<Vec3>& y, const std::vector<Vec3>& v, Pull& pull) const;
    void listStiff();
    void solveSmall(std::vector<double>& t) const;
    void addSlopes(const Actuators& actuators, double sign, const std::vector<Vec3>& in, std::vector<Vec3>& out) const;

    std::vector<Pull> m_pulls;  // chambers, then cables
    // Actuators with a stiffness that pull: indices, P g, the Cholesky factor of (c h^2 kappa)^-1 + G^T P G, and
    // scratch.
    std::vector<int> m_stiff;
    std::vector<std::vector<Vec3>> m_Pg;
    std::vector<double> m_small;
    mutable std::vector<double> m_t;
    std::vector<Vec3> m_nodes;
    PullFactors m_factors;
};

/// The preconditioner P of A with the body's actuators.
class ActuatedPreconditioner : public LinearOperator
{
public:
    ActuatedPreconditioner(const LinearOperator& P, const Actuation& actuation, const Actuators& actuators)
        : m_P(P), m_actuation(actuation), m_actuators(actuators)
    {
    }
    void apply(const std::vector<Vec3>& in, std::vector<Vec3>& out) const override
    {
        m_P.apply(in, out);
        m_actuation.correct(m_actuators, out);
    }

private:
    const LinearOperator& m_P;
    const Actuation& m_actuation;
    const Actuators& m_actuators;
};

}  // namespace bullet_fem

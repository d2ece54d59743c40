// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <vector>

#include "bullet_fem/fem/body/actuators.h"
#include "fem/body/conjugate_gradients.h"

namespace bullet_fem
{

/// With what a step of h multiplies (StepCoefficients): see Actuation.
struct PullFactors
{
    double m_step = 0;        ///< h [s]
    double m_ofVelocity = 0;  ///< s h [s]
    double m_ofTurning = 0;   ///< e h [s], e = StepCoefficients::turningOfLength()
    double m_inMatrix = 0;    ///< c h^2 [s2]
};

/// What a body's actuators are in one step: linearized about the kick positions y. An actuator of the scalar q(x), with
/// the gradient g = dq/dx, does to the nodes the force
///
///     Q g,   Q = Q(q(y)) - kappa (s h g . v + c h g . dv - e h g . turning),   kappa = -dQ/dq >= 0
///
/// Q is the gauge pressure of a chamber, with kappa = p_absolute / V of a sealed gas, or minus the tension of a cable,
/// with kappa its stiffness. So A gets c h^2 kappa g g^T, a positive semidefinite matrix of rank one, as the
/// material's h^2 K': a step is stable at any kappa. The preconditioner P follows by the formula of Woodbury, so that
/// conjugate gradients do not see how large kappa is. Cables add their tensile geometric stiffness, tension / length
/// (I - d d^T) of every straight part of the direction d, to T in A.
class Actuation
{
public:
    /// At the positions y, with the velocities v before the step. Does not allocate once it has seen as many triangles
    /// and points.
    void begin(const Actuators& actuators, const PullFactors& factors, const std::vector<Vec3>& y,
               const std::vector<Vec3>& v);

    double step() const { return m_factors.m_step; }  ///< h [s]

    /// Sets the part of Q that is known before the step is solved, from the velocities v and how they turn, and adds
    /// that times g to the nodes' forces [N].
    void addForces(const Actuators& actuators, const std::vector<Vec3>& v, const std::vector<Vec3>& turning,
                   std::vector<Vec3>& force);

    /// b -= A's part, times in.
    void subtractFromRightSide(const Actuators& actuators, const std::vector<Vec3>& in, std::vector<Vec3>& b);

    /// out += A's part, times in.
    void addProduct(const Actuators& actuators, const std::vector<Vec3>& in, std::vector<Vec3>& out) const;

    /// True if something of the step's has a stiffness, so that the following is to be called.
    bool isStiff() const { return !m_stiff.empty(); }

    /// Prepares what follows for a preconditioner of A without its actuators: one application for each that is stiff.
    void factor(const Actuators& actuators, const LinearOperator& preconditioner);

    /// P r, of A with its actuators, from that of A without: (P^-1 + sum c h^2 kappa g g^T)^-1 r.
    void correct(const Actuators& actuators, std::vector<Vec3>& Pr) const;

    /// Tells lift() that the right-hand side has the stiff actuators' part of A, times in.
    void setRightSide(const Actuators& actuators, const std::vector<Vec3>& in);

    /// The change of velocities that answers the stiff actuators' part of b, as far as the preconditioner knows A: what
    /// that leaves of b is of the size of the material's forces, however stiff they are.
    const std::vector<Vec3>& lift();

    /// Lets cables go that would push in a step that changes the velocities of the free nodes by dv: their part is
    /// taken out of b, over the nodes that are not fixed, and out of A. True if there was one; then factor() is due.
    bool releaseSlack(const Actuators& actuators, const std::vector<unsigned char>& fixed, const std::vector<Vec3>& dv,
                      std::vector<Vec3>& b);

    /// Square of the forces' norm over the nodes, about [N2]: for the tolerance of the solve.
    double squaredForces(const Actuators& actuators) const;

private:
    struct Pull
    {
        std::vector<Vec3> m_gradient;  // of a chamber: each triangle's, for each of its nodes [m2]; of a cable: the
                                       // direction of each straight part [-]
        std::vector<double> m_slope;   // of a cable: tension / length of each straight part, times c h^2 [kg]
        double m_force = 0;            // Q(q(y)) [Pa] or [N]
        double m_stiffness = 0;        // kappa [Pa/m3] or [N/m]
        double m_rightSide = 0;        // g times this is in b [Pa s] or [N s]
        bool m_pulls = true;           // false: a cable that is slack
    };
    static void beginChamber(const Chamber& chamber, const std::vector<Vec3>& y, Pull& pull);
    void beginCable(const Cable& cable, const std::vector<Vec3>& y, const std::vector<Vec3>& v, Pull& pull) const;
    void listStiff();
    void solveSmall(std::vector<double>& t) const;
    void addSlopes(const Actuators& actuators, double sign, const std::vector<Vec3>& in, std::vector<Vec3>& out) const;

    std::vector<Pull> m_pulls;  // chambers, then cables
    // Of those with a stiffness, which pull: their indices, P g, the Cholesky factor of (c h^2 kappa)^-1 + G^T P G, and
    // scratch.
    std::vector<int> m_stiff;
    std::vector<std::vector<Vec3>> m_Pg;
    std::vector<double> m_small;
    mutable std::vector<double> m_t;
    std::vector<Vec3> m_nodes;
    PullFactors m_factors;
};

/// P of A with the body's actuators.
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

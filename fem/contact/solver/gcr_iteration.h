// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <array>
#include <vector>

#include "fem/contact/solver/joint_system.h"

namespace bullet_fem
{

/// The outer iterations of a solve as generalized conjugate residuals [Eisenstat et al. 1983]: the bodies' true systems
/// are the operator, the joints' factor is the preconditioner. Each outer iteration starts from the combination of
/// previous impulses with minimum residual, so it converges however strained the bodies are. Grows, never shrinks.
class GcrIteration
{
public:
    /// Both must outlive it.
    GcrIteration(ContactRows& rows, JointSystem& joints) : m_rows(rows), m_joints(joints) {}

    /// Call when the joints are assembled anew.
    void begin();

    /// Call after the true velocities were measured. `othersMoved`: rows of others have changed the bodies since.
    void look(bool othersMoved = false);

    /// Maximum missing impulse of a joint, relative to the maximum impulse on its bodies; values below `negligible`
    /// [m/s], as velocity of a row's own point, count as zero.
    double largestShare(double negligible) const;

    /// Maximum velocity error of a joint's sides [m/s].
    double largestSpeed() const;

    /// Call at the start of the next outer iteration: sets the best impulses of the joints, and passes them the
    /// residual of these.
    void combine();

    /// True if the residual of the best combination is much smaller than that of the last outer iteration.
    bool isBestBehind() const;

    /// Sets the best impulses of the joints; the bodies must then be solved for these.
    void takeBest();

private:
    static constexpr int kDirections = 20;  // directions that are kept

    // Impulses [N s], their residual [m/s], and the preconditioned residual [N s]; or differences of these.
    struct Vectors
    {
        std::vector<double> m_impulse, m_left, m_answer;

        void resize(int size);
        double square() const;
        void add(double share, const Vectors& other);
    };

    bool noteActing();
    void noteDirection();
    void noteLargest();
    template <class Visit>
    void forEndsOf(const ContactRow& row, const Visit& visit) const;

    ContactRows& m_rows;
    JointSystem& m_joints;
    Vectors m_now, m_best;  // of the last outer iteration, and of the best combination
    std::array<Vectors, kDirections> m_directions;
    int m_count = 0, m_next = 0;  // number of directions, and the slot of the next one
    bool m_hasBest = false;
    int m_changes = 0;                    // JointSystem::changes() at the time of these data
    std::vector<unsigned char> m_acting;  // per row: an active contact in the last outer iteration
    std::vector<double> m_before, m_shift;
    std::vector<double> m_largest;  // maximum impulse per mover in the last outer iteration [N s]
};

}  // namespace bullet_fem

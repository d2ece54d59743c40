// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <array>
#include <vector>

#include "fem/contact/joint_system.h"

namespace bullet_fem
{

/// The rounds of a solve as the steps of generalized conjugate residuals [Eisenstat et al. 1983]: the bodies' true
/// systems are the operator, the joints' factor is the preconditioner. Each round starts from that combination of the
/// impulses so far which leaves the least, so rounds converge however strained bodies are. Grows, never shrinks.
class GcrIteration
{
public:
    /// Both must outlive it.
    GcrIteration(ContactRows& rows, JointSystem& joints) : m_rows(rows), m_joints(joints) {}

    /// When the joints are assembled anew.
    void begin();

    /// When the true velocities have been measured. `othersMoved`: rows of others have changed the bodies since.
    void look(bool othersMoved = false);

    /// The largest impulse that a joint lacked then, as a share of the largest on its bodies; less than `negligible`
    /// [m/s] of a row's own point is nothing.
    double largestShare(double negligible) const;

    /// The largest speed at which the ends of a joint then missed what it asks for [m/s].
    double largestSpeed() const;

    /// After that, at the start of another round: gives the joints the best impulses, and tells them what these leave.
    void combine();

    /// True if the best impulses leave much less than the last round has.
    bool isBestBehind() const;

    /// Gives the joints the best impulses, which the bodies are to be solved for.
    void takeBest();

private:
    static constexpr int kDirections = 20;  // that are remembered

    // Impulses [N s], what they leave [m/s], and the answer to that [N s]; or differences of them.
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
    Vectors m_now, m_best;  // of the last round, and the best combination of all
    std::array<Vectors, kDirections> m_directions;
    int m_count = 0, m_next = 0;  // of these, and where the next one goes
    bool m_hasBest = false;
    int m_changes = 0;                    // JointSystem::changes() that all this belongs to
    std::vector<unsigned char> m_acting;  // per row: a contact that acted after the last round
    std::vector<double> m_before, m_shift;
    std::vector<double> m_largest;  // impulse per body, of the last round [N s]
};

}  // namespace bullet_fem

// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include "bullet_fem/fem/factor/body_model.h"

/// Cost of a new factor in iterations with this model's factor [-]. Computed from its size, not measured, so that
/// decisions based on it are deterministic.
double refactorPrice(const bullet_fem::BodyModel& model);

/// Additional iterations, compared with a fresh factor, to lower the residual to `tolerance` [-] with a factor whose
/// step or masses differ by the ratio `mismatch` (>= 1; infinite: other nodes are fixed).
double iterationsLostTo(double mismatch, double tolerance);

/// Account of the cost of a body's stale factor. A new factor pays once the old one has cost its price: the total is
/// then at most twice that of the best choice in hindsight (rent or buy [Karlin et al. 1988]). If factors never last,
/// as with a step that changes all the time, each factor that has not paid off doubles the price of the next.
class btFemFactorAccount
{
public:
    btFemFactorAccount() = default;

    /// Adds a step's iterations with the present factor; `mismatch` as in iterationsLostTo, 1 for a fresh factor.
    void note(int iterations, double mismatch, double tolerance);

    /// Adds the corrective solves of contact in a step with the factor of other pins.
    void noteContact(int iterations) { m_lost += iterations; }

    /// True if the factor was stale in the last step and has cost `price` iterations or more.
    bool refactorPays(double price) const { return m_stale && m_lost >= price * m_dearness; }

    /// Resets the account after a factor, of that price [iterations], that the account requested.
    void spend(double price);

    /// Resets the account after a factor with another cause.
    void clear() { *this = btFemFactorAccount(m_fresh); }

    /// Reads or writes the members of a snapshot.
    template <class Bytes>
    void transfer(Bytes& bytes)
    {
        bytes(m_fresh, m_stale, m_lost, m_dearness, m_owed, m_rate, m_staleSteps);
    }

private:
    explicit btFemFactorAccount(double fresh) : m_fresh(fresh) {}

    double m_fresh = -1;    // mean iterations per step with a fresh factor; < 0: unknown
    bool m_stale = false;   // the factor was stale in the last step
    double m_lost = 0;      // iterations lost since the account began
    double m_dearness = 1;  // factor on the price
    double m_owed = 0;      // iterations that the last factor has still to save
    double m_rate = 0;      // iterations per step that it was expected to save
    int m_staleSteps = 0;   // stale steps since the account began
};

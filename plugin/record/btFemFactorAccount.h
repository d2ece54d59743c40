// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include "bullet_fem/fem/factor/body_model.h"

/// What a new factor costs, in iterations with this model's [-]. Counted from its size, not measured, so that decisions
/// that rest on it are the same on every machine.
double refactorPrice(const bullet_fem::BodyModel& model);

/// How many iterations more than with a fresh factor one can need whose step or masses are `mismatch` times off (>= 1;
/// infinite: other nodes are fixed), to lower the residual to `tolerance` [-].
double iterationsLostTo(double mismatch, double tolerance);

/// Keeps account of what a body's stale factor costs. A new one pays as soon as the old one has cost as much: then the
/// sum is never more than twice what the best choice in hindsight would have cost, whatever comes (rent or buy [Karlin
/// et al. 1988]). Where factors never last, as with a step that changes all the time, each one that has not earned its
/// price makes the next twice as dear.
class btFemFactorAccount
{
public:
    btFemFactorAccount() = default;

    /// Takes over a step's iterations with the factor that the body has; `mismatch` as in iterationsLostTo, 1 for a
    /// fresh factor.
    void note(int iterations, double mismatch, double tolerance);

    /// True if the factor was stale in the last step and has cost `price` iterations or more.
    bool refactorPays(double price) const { return m_stale && m_lost >= price * m_dearness; }

    /// Begins anew, with a factor at that price [iterations] that the account called for.
    void spend(double price);

    /// Begins anew, with a factor that somebody else called for.
    void clear() { *this = btFemFactorAccount(m_fresh); }

    /// Its members, to or from a snapshot.
    template <class Bytes>
    void transfer(Bytes& bytes)
    {
        bytes(m_fresh, m_stale, m_lost, m_dearness, m_owed, m_rate, m_staleSteps);
    }

private:
    explicit btFemFactorAccount(double fresh) : m_fresh(fresh) {}

    double m_fresh = -1;    // mean iterations a step with a fresh factor; < 0: not known
    bool m_stale = false;   // in the last step
    double m_lost = 0;      // iterations since the account began
    double m_dearness = 1;  // by how much the price is raised
    double m_owed = 0;      // what the last factor has yet to earn [iterations]
    double m_rate = 0;      // iterations a step that it was to save
    int m_staleSteps = 0;   // since the account began
};

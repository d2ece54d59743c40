// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <vector>

#include "bullet_bridge/contact_finder.h"
#include "plugin/btFemBodyRegistry.h"

/// One step of all FEM bodies of a world, in the two places where Bullet calls its soft body solver: before collision
/// detection and after the rigid bodies have moved. Scratch only; what lasts is in the registry.
class btFemWorldStep
{
public:
    explicit btFemWorldStep(const btFemSolverInfo& info) : m_info(info) {}

    /// Before collision detection: sets new bodies up, takes over what the user wrote, lets Bullet add wind and
    /// pressure to m_f, and gives the broad phase the bounds of the motion to come.
    void predict(btFemBodyRegistry& registry, double step);

    /// After it: free motion, contact, correction, and the new positions. `step` [s].
    void solve(btFemBodyRegistry& registry, double step);

private:
    void collectActive(btFemBodyRegistry& registry, double worldStep);
    void readBody(btFemEntry& entry);
    void solveFree(btFemEntry& entry);
    void solveContacts(double step);
    void findContacts(double step);
    void splitContacts(const bullet_fem::ContactReport& report, double milliseconds);
    void finish(btFemEntry& entry);
    bullet_fem::StepSettings settingsOf(const btFemEntry& entry) const;

    btFemSolverInfo m_info;
    std::vector<btFemEntry*> m_active;
    std::vector<bullet_fem::ContactBody> m_contactBodies;
    std::vector<bullet_fem::ContactPoint> m_contacts;
    bullet_fem::ContactFinder m_finder;
    bullet_fem::RigidObstacles m_rigid;
    bullet_fem::ContactSolver m_solver;
};

/// True if a step [s] is one that bodies can be stepped with.
bool isUsableStep(double step);

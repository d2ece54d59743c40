// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <gtest/gtest.h>

#include <algorithm>

#include "bridge/bridge_test_bodies.h"
#include "btBulletDynamicsCommon.h"
#include "bullet_bridge/contact/rigid/rigid_search.h"
#include "bullet_fem/fem/common/threads.h"
#include "bullet_fem/fem/step/stepping.h"

namespace bullet_fem
{

/// The unit cube of two cells a side with its bottom at z = 0; the fixture runs a contact finder against objects.
class ContactFinderScene : public ::testing::Test
{
protected:
    static constexpr double kStep = 1.0 / 60;  ///< [s]

    ContactFinderScene()
    {
        m_info.m_broadphase = nullptr;
        m_box.m_body->m_worldInfo = &m_info;
    }

    const std::vector<ContactPoint>& find(const btCollisionObject& object, int most = 1000)
    {
        m_fem.m_overlaps.m_rigid.clear();
        recordOverlap(m_fem, object);
        solveFreeMotion(m_fem.m_body, StepSettings());
        m_rigidProxies.clear();
        m_search.find({&m_fem}, kStep, most, m_rigidProxies);
        m_report = m_search.reports().front();
        return m_fem.m_memory.m_contacts;
    }

    std::vector<ContactPoint>::const_iterator deepest() const
    {
        return std::min_element(m_fem.m_memory.m_contacts.begin(), m_fem.m_memory.m_contacts.end(),
                                [](const auto& a, const auto& b) { return a.m_gap < b.m_gap; });
    }

    btSoftBodyWorldInfo m_info;
    TestBox m_box;
    FemSoftBody m_fem = makeFemSoftBody(*m_box.m_body);
    RigidProxies m_rigidProxies;
    Threads m_threads;
    RigidSearch m_search{m_threads};
    ContactSearchReport m_report;
};

}  // namespace bullet_fem

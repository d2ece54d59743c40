// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "plugin/dispatch/btFemDispatch.h"

#include "BulletSoftBody/btSoftBody.h"
#include "bullet_bridge/body/rigid_dispatch.h"
#include "plugin/dispatch/btFemContactTest.h"
#include "plugin/dispatch/btFemManifolds.h"

namespace
{

void announce(btSoftBody& body, bool withManifolds)
{
    if (!body.m_worldInfo) return;
    btDispatcher* dispatcher = body.m_worldInfo->m_dispatcher;
    bullet_fem::dispatchRigidShapes(dispatcher);
    if (withManifolds) btFemManifolds::showIn(dispatcher);  // its algorithms replace the former ones
    answerContactTests(dispatcher);
    bullet_fem::renewAlgorithms(body);  // pairs from before it was FEM have Bullet's algorithms
}

}  // namespace

void announceToDispatcher(btSoftBody& body)
{
    announce(body, false);
}

void announceWithManifolds(btSoftBody& body)
{
    announce(body, true);
}

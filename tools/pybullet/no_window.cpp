// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "Bullet3Common/b3Logging.h"
#include "SharedMemory/SharedMemoryInProcessPhysicsC_API.h"

// pybullet.connect() calls these functions of Bullet's windows and servers, which are not built; with null it returns
// -1.

namespace
{

b3PhysicsClientHandle refuse()
{
    b3Error("this pybullet has no windows and servers: use pybullet.DIRECT\n");
    return nullptr;
}

}  // namespace

b3PhysicsClientHandle b3CreateInProcessPhysicsServerAndConnect(int, char**)
{
    return refuse();
}

b3PhysicsClientHandle b3CreateInProcessPhysicsServerAndConnectMainThread(int, char**)
{
    return refuse();
}

b3PhysicsClientHandle b3CreateInProcessPhysicsServerAndConnectSharedMemory(int, char**)
{
    return refuse();
}

b3PhysicsClientHandle b3CreateInProcessPhysicsServerAndConnectMainThreadSharedMemory(int, char**)
{
    return refuse();
}

b3PhysicsClientHandle b3CreateInProcessGraphicsServerAndConnectSharedMemory(int)
{
    return refuse();
}

b3PhysicsClientHandle b3CreateInProcessGraphicsServerAndConnectMainThreadSharedMemory(int)
{
    return refuse();
}

b3PhysicsClientHandle b3CreateInProcessPhysicsServerFromExistingExampleBrowserAndConnect3(void*, int)
{
    return refuse();
}

b3PhysicsClientHandle b3CreateInProcessPhysicsServerFromExistingExampleBrowserAndConnect4(void*, int)
{
    return refuse();
}

// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "python/core/handles.h"

PYBIND11_MODULE(_core, module)
{
    using namespace bullet_fem::python;
    checkSharedBullet();
    py::options options;
    options.disable_function_signatures();
    module.doc() = "Soft bodies of finite elements in Bullet's worlds. SI units; quaternions are (x, y, z, w).";
    module.attr("__version__") = BULLETFEM_VERSION;
    module.attr("has_pictures") =
#ifdef BULLETFEM_HAS_PICTURES
        true;
#else
        false;
#endif
    module.attr("__name__") = "bulletfem";  // of the classes, too
    bindMaterials(module);
    bindMeshes(module);
    bindShapes(module);
    bindReports(module);
    WorldClass world = bindWorld(module);
    bindRigidBodies(module);
    SoftClass body = bindSoftBodies(module);
    bindState(world);
    bindStepping(world);
    bindMakers(world);
    bindJoints(module, world);
    bindNodes(body);
    bindStress(body);
    bindContacts(module, body, world);
    bindHolds(body);
    bindActuators(body);
    bindBreaking(body, world);
    bindRays(body, world);
    bindPictures(world);
    bindBatch(module);
    bindRobots(module, world);
    module.attr("__name__") = "bulletfem._core";
}

// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include <dlfcn.h>
#include <link.h>

#include <stdexcept>

#include "LinearMath/btTransform.h"
#include "python/core/bullet_world.h"

namespace bullet_fem::python
{
namespace
{

// GCC makes static objects of inline functions unique in the process (STB_GNU_UNIQUE), even between extensions that are
// loaded locally. btTransform::getIdentity() has one, by the same name in both of Bullet's precisions.
constexpr const char* kIdentity = "_ZZN11btTransform11getIdentityEvE17identityTransform";
constexpr const char* kGuard = "_ZGVZN11btTransform11getIdentityEvE17identityTransform";

bool isIdentity(const btTransform& transform)
{
    bool is = transform.getOrigin().length2() == 0;
    for (int i = 0; i < 3; ++i)
        for (int k = 0; k < 3; ++k) is = is && transform.getBasis()[i][k] == (i == k ? 1 : 0);
    return is;
}

/// Whether the object that this module sees has the size and the value that it must have.
bool sharedObjectIsGood()
{
    static const int anchor = 0;
    Dl_info info;
    if (dladdr(&anchor, &info) == 0) return true;
    void* module = dlopen(info.dli_fname, RTLD_LAZY | RTLD_NOLOAD);
    if (!module) return true;
    const void* identity = dlsym(module, kIdentity);
    const auto* guard = static_cast<const unsigned char*>(dlsym(module, kGuard));
    dlclose(module);
    if (!identity) return true;  // Bullet is linked into this module
    const ElfW(Sym)* symbol = nullptr;
    void** at = const_cast<void**>(reinterpret_cast<const void**>(&symbol));
    if (dladdr1(identity, &info, at, RTLD_DL_SYMENT) != 0 && symbol && symbol->st_size != sizeof(btTransform))
        return false;
    return !guard || *guard == 0 || isIdentity(*static_cast<const btTransform*>(identity));
}

}  // namespace

void checkSharedBullet()
{
    if (!sharedObjectIsGood())
        throw std::runtime_error(
            "another extension of this process, such as pybullet, has Bullet in single precision, and the dynamic "
            "linker "
            "shares Bullet's static objects with it, whose values are wrong here: use the two in separate processes");
}

}  // namespace bullet_fem::python

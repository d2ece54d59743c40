// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "tools/pictures/font.h"

// The assembler includes the file as it is; compiling it as a C++ array would take seconds.
__asm__(
    ".section .rodata\n"
    ".balign 16\n"
    "bulletfem_embedded_font:\n"
    ".incbin \"" BULLETFEM_FONT_FILE
    "\"\n"
    "bulletfem_embedded_font_end:\n"
    ".byte 0\n"
    ".previous\n");
extern "C" const unsigned char bulletfem_embedded_font[] __attribute__((visibility("hidden")));
extern "C" const unsigned char bulletfem_embedded_font_end[] __attribute__((visibility("hidden")));

namespace bullet_fem
{

const unsigned char* embeddedFont()
{
    return bulletfem_embedded_font;
}

int embeddedFontSize()
{
    return static_cast<int>(bulletfem_embedded_font_end - bulletfem_embedded_font);
}

}  // namespace bullet_fem

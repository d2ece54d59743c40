// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

namespace bullet_fem
{

/// The bytes of DejaVu Sans, a TrueType font that may be embedded (Bitstream Vera's licence), included at build time.
const unsigned char* embeddedFont();
int embeddedFontSize();

}  // namespace bullet_fem

// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include "bullet_fem/btFemPrecision.h"
#include "bullet_fem/fem/common/export.h"

/// Text of a report flag, for programs that show reports to people.
struct BULLETFEM_API btFemFlagText
{
    int m_flag = 0;                  ///< bit of btFemFlags
    const char* m_name = "";         ///< name in source code, such as "BT_FEM_INSIDE_OUT"
    const char* m_title = "";        ///< short title, such as "inside out"
    const char* m_explanation = "";  ///< sentences on cause and remedy

    /// The text of a flag; null if it is not one of btFemFlags. Any thread may call it. Does not allocate.
    static const btFemFlagText* find(int flag);
};

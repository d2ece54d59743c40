// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include "bullet_fem/btFemPrecision.h"
#include "bullet_fem/fem/common/export.h"

/// One of btFemFlags in words, for programs that show reports to people.
struct BULLETFEM_API btFemFlagText
{
    int m_flag = 0;                  ///< of btFemFlags
    const char* m_name = "";         ///< in source, such as "BT_FEM_INSIDE_OUT"
    const char* m_title = "";        ///< in a few words, such as "inside out"
    const char* m_explanation = "";  ///< whole sentences: what happened, and what to change

    /// The words of a flag; null if it is not one of btFemFlags. Any thread may call it.
    static const btFemFlagText* find(int flag);
};

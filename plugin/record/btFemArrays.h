// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include "LinearMath/btAlignedObjectArray.h"

/// Whether the pointer is one of the array's.
template <class T>
bool btFemHolds(const btAlignedObjectArray<T*>& array, const T* element)
{
    return array.findLinearSearch(const_cast<T*>(element)) < array.size();
}

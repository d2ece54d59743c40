// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include "LinearMath/btAlignedObjectArray.h"

/// True if the pointer points into the array.
template <class T>
bool btFemHolds(const btAlignedObjectArray<T*>& array, const T* element)
{
    return array.findLinearSearch(const_cast<T*>(element)) < array.size();
}

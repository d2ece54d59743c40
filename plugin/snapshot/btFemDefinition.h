// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <cstddef>
#include <vector>

class btFemBodyRegistry;
class btSoftBody;

/// Writes the definition of a body to `buffer`; for a body that is not FEM yet, that which it would get now. Throws
/// std::invalid_argument if it is null or has no usable tetrahedra.
void saveDefinition(const btFemBodyRegistry& registry, const btSoftBody* body, std::vector<unsigned char>& buffer);

/// Gives a body the definition in `data`, used when it is next stepped or prepared; its nodes are not moved. Throws
/// std::invalid_argument, and changes nothing, if the definition is invalid or does not fit the body.
void applyDefinition(btFemBodyRegistry& registry, btSoftBody* body, const unsigned char* data, std::size_t size);

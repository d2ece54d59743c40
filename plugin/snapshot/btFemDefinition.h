// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <cstddef>
#include <vector>

class btFemBodyRegistry;
class btSoftBody;

/// Writes the definition of a body. One that is not FEM yet is what it would become now. Throws std::invalid_argument
/// on null, or a body without usable tetrahedra.
void saveDefinition(const btFemBodyRegistry& registry, const btSoftBody* body, std::vector<unsigned char>& buffer);

/// Makes a body one of that definition when it is stepped or prepared next; its nodes stay where they are. Throws
/// std::invalid_argument, before it has changed anything, if that cannot be.
void applyDefinition(btFemBodyRegistry& registry, btSoftBody* body, const unsigned char* data, std::size_t size);

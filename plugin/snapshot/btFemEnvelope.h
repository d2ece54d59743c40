// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <cstddef>
#include <vector>

#include "fem/common/byte_stream.h"

/// What a buffer is said to hold.
enum class btFemContents : unsigned int
{
    state = 1,      ///< of btFemSoftBodySolver::saveState
    definition = 2  ///< of btFemSoftBodySolver::saveDefinition
};

// A header around contents of any kind: magic bytes, byte order, version, precision of btScalar, kind, size, checksum.

/// Empties the buffer but for a header, which closeEnvelope completes.
void beginEnvelope(std::vector<unsigned char>& buffer, btFemContents contents);
void closeEnvelope(std::vector<unsigned char>& buffer);

/// The contents of a buffer that may be anything. Throws std::invalid_argument, saying what is wrong, unless it is
/// whole, unchanged, of this kind, and was written by this version in this precision and byte order.
bullet_fem::ByteReader openEnvelope(const unsigned char* data, std::size_t size, btFemContents contents);

// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "fem/common/attempt.h"
#include "fem/common/byte_stream.h"

/// Kind of a buffer's contents.
enum class btFemContents : unsigned int
{
    state = 1,       ///< of btFemSoftBodySolver::saveState
    definition = 2,  ///< of btFemSoftBodySolver::saveDefinition
    world = 3        ///< of btFemWorldState::save
};

// Header of a buffer: magic bytes, byte order, version, precision of btScalar, kind, size, checksum.

/// beginEnvelope() replaces the buffer's contents by a header; closeEnvelope() completes the header after the contents
/// were appended.
void beginEnvelope(std::vector<unsigned char>& buffer, btFemContents contents);
void closeEnvelope(std::vector<unsigned char>& buffer);

/// Returns a reader of the contents of an untrusted buffer. Throws std::invalid_argument with the reason unless the
/// buffer is complete, undamaged, of this kind, and was written by this version in this precision and byte order.
bullet_fem::ByteReader openEnvelope(const unsigned char* data, std::size_t size, btFemContents contents);

/// attempt() with the name of the caller in the message.
template <class Call>
bool attemptAs(const char* name, std::string* why, const Call& call)
{
    return bullet_fem::attempt(why,
                               [&]
                               {
                                   std::string reason;
                                   if (!bullet_fem::attempt(&reason, call)) bullet_fem::reject(name, ": ", reason);
                               });
}

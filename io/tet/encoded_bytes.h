// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace bullet_fem
{

/// A sequence of raw or base64 bytes, consumed from the front. Errors are std::runtime_error.
class EncodedBytes
{
public:
    EncodedBytes(std::string_view text, bool base64) : m_rest(text), m_base64(base64) {}

    /// The next bytes; throws if there are fewer. Base64 may contain padding in its middle, as after a separately
    /// encoded header.
    std::string take(std::size_t count);

    /// Upper bound of the remaining bytes.
    std::size_t most() const { return m_pending.size() + (m_base64 ? m_rest.size() / 4 * 3 : m_rest.size()); }

private:
    bool decodeQuartet(std::string& bytes);

    std::string_view m_rest;
    bool m_base64;
    std::string m_pending;  // decoded, not yet consumed
};

}  // namespace bullet_fem

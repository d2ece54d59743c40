// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace bullet_fem
{

/// Bytes that stand as they are or in base64, taken from the front. Errors are std::runtime_error.
class EncodedBytes
{
public:
    EncodedBytes(std::string_view text, bool base64) : m_rest(text), m_base64(base64) {}

    /// The next bytes; throws if there are fewer. Base64 may be padded in its midst, as behind a header that was
    /// encoded by itself.
    std::string take(std::size_t count);

    /// What can be taken, at most.
    std::size_t most() const { return m_pending.size() + (m_base64 ? m_rest.size() / 4 * 3 : m_rest.size()); }

private:
    bool decodeQuartet(std::string& bytes);

    std::string_view m_rest;
    bool m_base64;
    std::string m_pending;  // decoded, and not yet taken
};

}  // namespace bullet_fem

// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "bullet_bridge/body/body_mark.h"

#include <atomic>

#include "BulletSoftBody/btSoftBody.h"

namespace bullet_fem
{
namespace
{

constexpr btScalar kIsMark = btScalar(0xFE3);

// Encodes a mark as two integers that single precision represents exactly, and a third value that identifies a mark.
btVector3 coded(std::uint64_t mark)
{
    constexpr std::uint64_t kLow = (1u << 24) - 1;
    return {btScalar(mark & kLow), btScalar(mark >> 24 & kLow), kIsMark};
}

}  // namespace

std::uint64_t markBody(btSoftBody& body)
{
    static std::atomic<std::uint64_t> last{0};
    const std::uint64_t mark = ++last;
    body.m_tetras[0].m_c0[0] = coded(mark);
    return mark;
}

void unmarkBody(btSoftBody& body)
{
    if (isMarked(body)) body.m_tetras[0].m_c0[0].setZero();
}

bool isMarked(const btSoftBody& body)
{
    return body.m_tetras.size() > 0 && body.m_tetras[0].m_c0[0].z() == kIsMark;
}

bool hasMark(const btSoftBody& body, std::uint64_t mark)
{
    return body.m_tetras.size() > 0 && body.m_tetras[0].m_c0[0] == coded(mark);
}

}  // namespace bullet_fem

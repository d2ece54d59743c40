// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <cstdint>
#include <memory>

#include "bullet_fem/fem/factor/body_model.h"

class btFemBodyRegistry;
class btSoftBody;

namespace bullet_fem
{
struct BakedBody;
}

/// What a body that was baked is made of when it is set up.
struct btFemBaked
{
    std::shared_ptr<const bullet_fem::BodyModel> m_model;
    std::uint64_t m_restMark = 0;  ///< of the element matrices at the time: another rest shape has others
};

/// Makes a body one of that model when it is stepped or prepared next. Throws std::invalid_argument, before it has
/// changed anything, if its nodes or elements are others.
void useBaked(btFemBodyRegistry& registry, btSoftBody* body, const bullet_fem::BakedBody& baked);

/// True if the body still has the elements and the rest shape that it had then.
bool isAsBaked(const btSoftBody& body, const btFemBaked& baked);

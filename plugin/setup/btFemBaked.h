// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

class btFemBodyRegistry;
class btSoftBody;
struct btFemBaked;

namespace bullet_fem
{
struct BakedBody;
}

/// Makes a body one of that model when it is stepped or prepared next. Throws std::invalid_argument, before it has
/// changed anything, if its nodes or elements are others.
void useBaked(btFemBodyRegistry& registry, btSoftBody* body, const bullet_fem::BakedBody& baked);

/// True if the body still has the elements and the rest shape that it had then.
bool isAsBaked(const btSoftBody& body, const btFemBaked& baked);

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

/// Makes a body use the baked model when it is next stepped or prepared. Throws std::invalid_argument, and changes
/// nothing, if the body has other nodes or elements.
void useBaked(btFemBodyRegistry& registry, btSoftBody* body, const bullet_fem::BakedBody& baked);

/// True if the body still has the elements and the rest shape of useBaked().
bool isAsBaked(const btSoftBody& body, const btFemBaked& baked);

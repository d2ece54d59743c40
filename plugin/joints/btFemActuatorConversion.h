// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include "bullet_fem/fem/body/actuators.h"

struct btFemCable;
struct btFemChamber;
struct btFemExpansion;
struct btFemFibres;

// Convert the user's actuators to those of fem, without validation; only a list of triangle nodes whose length is not a
// multiple of three throws std::invalid_argument.
bullet_fem::Chamber coreChamber(const btFemChamber& given);
bullet_fem::Cable coreCable(const btFemCable& given);
bullet_fem::Fibres coreFibres(const btFemFibres& given);
bullet_fem::Expansion coreExpansion(const btFemExpansion& given);

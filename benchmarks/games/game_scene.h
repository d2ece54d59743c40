// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "benchmarks/games/game_world.h"

namespace bullet_fem
{

/// A scene as games have it.
struct GameScene
{
    std::string m_name;
    int m_frames = 240;
    int m_subSteps = 1;
    bool m_carriesItsWeight = false;  ///< at its end all soft bodies rest on what is not soft: the force has a law
    std::function<void(GameWorld&)> m_build;
    std::function<void(GameWorld&, double time)> m_drive;  ///< before every frame [s]; may be empty
};

/// Ten soft bodies (9,150 elements) and fifty rigid ones fall into a pit.
GameScene pit();

/// A block of 2,000 elements hangs on a static box by so many of its upper nodes, 9 or 121; nothing touches.
GameScene anchored(int anchors);

/// A thin mat slides over a floor and comes to rest: `cells` cells along both sides, (cells + 1)^2 points.
GameScene mat(int cells);

/// A soft block is squeezed between two plates with a friction of 10, and lifted, in four steps a frame.
GameScene pinch();

/// Twenty soft cubes on each other.
GameScene tower();

/// All of them.
std::vector<GameScene> gameScenes();

}  // namespace bullet_fem

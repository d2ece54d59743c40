// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <functional>
#include <memory>
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
    std::function<std::unique_ptr<Game>(const GameSettings&)> m_start;
    bool m_isOfBullet = false;  ///< it is run by Bullet alone, too
    std::string m_missing;      ///< what it cannot run without, and how to give it; empty where it can
};

/// One whose world is a GameWorld that `build` fills.
GameScene sceneOf(const std::string& name, int frames, int subSteps, bool carriesItsWeight,
                  const std::function<void(GameWorld&)>& build);

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

/// A car on Bullet's hinges drives over bumps on four soft tyres, which are anchored to their hubs by 36 nodes each.
GameScene car();

/// A soft ball falls onto another, which lies on a plane. Drawn: surfaces of 20,480 triangles collide; else their
/// cages, of the same 1,360 elements each, do.
GameScene balls(bool drawn);

/// PinchFriction of Bullet's deformable examples: two plates lift three soft blocks of 1,580 elements, the middle one
/// by the friction between blocks. `bulletSource`: a checkout of Bullet, which has the mesh; the scene is missing
/// without.
GameScene pinchFriction(const std::string& bulletSource);

/// TetraBunny of Bullet's soft demo falls onto waves of triangles: 1,374 elements, of which many are slivers.
GameScene tetraBunny(const std::string& bulletSource);

/// All of them.
std::vector<GameScene> gameScenes(const std::string& bulletSource);

}  // namespace bullet_fem

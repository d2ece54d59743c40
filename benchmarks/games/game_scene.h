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

/// A scene typical of games.
struct GameScene
{
    std::string m_name;
    int m_frames = 240;
    int m_subSteps = 1;
    bool m_carriesItsWeight = false;  ///< at the end other bodies carry the soft ones' weight
    std::function<std::unique_ptr<Game>(const GameSettings&)> m_start;
    bool m_isOfBullet = false;  ///< Bullet alone runs it, too
    std::string m_missing;      ///< a missing input and how to provide it; empty if the scene can run
};

/// A scene whose world is a GameWorld filled by `build`.
GameScene sceneOf(const std::string& name, int frames, int subSteps, bool carriesItsWeight,
                  const std::function<void(GameWorld&)>& build);

/// Ten soft bodies (9,150 elements) and fifty rigid ones fall into a pit, with this number of steps per
/// frame; the pit of several steps has fewer frames.
GameScene pit(int subSteps);

/// A block of 2,000 elements hangs from a static box by `anchors` of its upper nodes, 9 or 121; there is no contact.
GameScene anchored(int anchors);

/// A thin mat slides over a floor and comes to rest: `cells` cells along both sides, (cells + 1)^2 points.
GameScene mat(int cells);

/// Two plates with a friction of 10 squeeze and lift a soft block, with four steps per frame.
GameScene pinch();

/// A stack of twenty soft cubes.
GameScene tower();

/// A car on Bullet's hinges drives over bumps on four soft tyres, each anchored to its hub by 36 nodes.
GameScene car();

/// A soft ball falls onto another one, which lies on a plane. `drawn`: surfaces of 20,480 triangles collide, else their
/// cages of 1,360 elements each.
GameScene balls(bool drawn);

/// PinchFriction of Bullet's deformable examples: two plates lift three soft blocks of 1,580 elements; friction between
/// the blocks carries the middle one. `bulletSource`: a source tree of Bullet, which contains the mesh; without it the
/// scene is marked as missing.
GameScene pinchFriction(const std::string& bulletSource);

/// TetraBunny of Bullet's soft demo falls onto waves of triangles: 1,374 elements, many of them slivers.
GameScene tetraBunny(const std::string& bulletSource);

/// Five soft cubes of 125 kg and five rigid boxes of 2.5 kg stand on each other in turn.
GameScene lightBoxes();

/// A rigid box of this mass [kg] on a soft cube of 1 kg.
GameScene heavyOnLight(int mass);

/// Eighteen soft cubes start with overlaps of 13 % of their edges.
GameScene jam();

/// A plate of 4,805 elements hangs by all 1,024 nodes of its upper face.
GameScene manyAnchors();

/// A thousand soft cubes of one cell fall asleep on the ground.
GameScene cellsAtRest();

/// A thousand soft cubes of one cell sleep on the ground.
GameScene cellsAsleep();

/// All scenes.
std::vector<GameScene> gameScenes(const std::string& bulletSource);

}  // namespace bullet_fem

// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "bullet_fem/btFemFlagText.h"
#include "tools/scene/scene_world.h"

namespace bullet_fem
{

/// Occurrences of one flag in the reports of a soft body.
struct SceneFlag
{
    std::string m_body;                     ///< its name
    const btFemFlagText* m_text = nullptr;  ///< the flag; not null
    double m_first = 0, m_last = 0;         ///< end of the first and of the last step with it [s]
    long m_steps = 0;                       ///< number of steps with it
    std::string m_message;                  ///< of the first report; may be empty

    /// Time of occurrence: "0.02 s", or "0.02 s to 1.5 s, in 40 steps".
    std::string when() const;
    /// The event and its remedy, with the report's message.
    std::string explanation() const;
};

/// All flags in soft bodies' reports since the start.
class SceneFlags
{
public:
    /// Call after each step. If the scene was set back in time, later flags are removed.
    void look(const SceneWorld& world);

    /// All flags in the order of their first occurrence.
    std::vector<SceneFlag> all() const;

private:
    void note(const SceneWorld& world, int body, int flag);
    void forgetAfter(double time, double step);

    std::map<std::pair<int, int>, SceneFlag> m_flags;  // key: index of the body, and flag
    double m_time = 0;                                 // of the last call of look() [s]
};

}  // namespace bullet_fem

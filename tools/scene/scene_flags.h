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

/// A flag that reports of a soft body have had.
struct SceneFlag
{
    std::string m_body;                     ///< its name
    const btFemFlagText* m_text = nullptr;  ///< which flag; not null
    double m_first = 0, m_last = 0;         ///< ends of the first and of the last step with it [s]
    long m_steps = 0;                       ///< with it
    std::string m_message;                  ///< of the first of these reports; may be empty

    /// When it was raised: "0.02 s", or "0.02 s to 1.5 s, in 40 steps".
    std::string when() const;
    /// The event and its remedy, with the report's message.
    std::string explanation() const;
};

/// Every flag that soft bodies' reports have had since the start.
class SceneFlags
{
public:
    /// After every step. If the scene was put back in time since, what was raised later is forgotten.
    void look(const SceneWorld& world);

    /// In the order in which they were first raised.
    std::vector<SceneFlag> all() const;

private:
    void note(const SceneWorld& world, int body, int flag);
    void forgetAfter(double time, double step);

    std::map<std::pair<int, int>, SceneFlag> m_flags;  // by the body's index and the flag
    double m_time = 0;                                 // of the last look [s]
};

}  // namespace bullet_fem

// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <vector>

#include "bullet_fem/io/body_frame.h"
#include "demos/compare/compared_scenes.h"

namespace bullet_fem
{

constexpr double kNoStack = -1e9;  ///< ComparedRun::m_height of a scene without a stack [-]

/// Results of one side in a scene.
struct ComparedRun
{
    std::vector<double> m_stepMs;                  ///< processor time of each step [ms]
    std::vector<std::vector<BodyFrame>> m_frames;  ///< all surfaces, every kStepsPerFrame steps
    std::vector<Vec3> m_colours;                   ///< of each of a frame's bodies (sRGB)
    int m_elements = 0;                            ///< tetrahedra of all bodies
    double m_deepest = 0;                          ///< of a node below the ground, ever [m]
    double m_inside = 0;                           ///< of a node in a rigid body that moves, ever [m]
    double m_height = kNoStack;                    ///< of a stack's top at the end over that at the start [-]
    double m_fastest = 0;                          ///< of a rigid body at the end [m/s]
    double m_inverted = 0;                         ///< largest share of elements that were inside out [-]

    double medianMs() const;
    double worstMs() const;
};

constexpr int kStepsPerFrame = 3;  ///< of 1/60 s: films have 20 frames a second

/// Plays the scene to `seconds`.
ComparedRun play(const ComparedScene& scene, ComparedSide& side, double seconds);

}  // namespace bullet_fem

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
    std::vector<std::vector<BodyFrame>> m_frames;  ///< all surfaces, at every kStepsPerFrame-th step
    std::vector<Vec3> m_colours;                   ///< of each body in a frame (sRGB)
    int m_elements = 0;                            ///< tetrahedra of all bodies
    double m_deepest = 0;                          ///< largest depth of a node below the ground [m]
    double m_inside = 0;                           ///< largest depth of a node in a moving rigid body [m]
    double m_height = kNoStack;                    ///< final height of a stack's top over its initial height [-]
    double m_fastest = 0;                          ///< maximum speed of a rigid body at the end [m/s]
    double m_inverted = 0;                         ///< largest share of inverted elements [-]

    double medianMs() const;
    double worstMs() const;
};

constexpr int kStepsPerFrame = 3;  ///< steps of 1/60 s: films have 20 frames per second

/// Runs the scene up to `seconds`.
ComparedRun play(const ComparedScene& scene, ComparedSide& side, double seconds);

}  // namespace bullet_fem

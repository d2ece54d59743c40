// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "tools/pictures/picture_scene.h"
#include "tools/pictures/viewer_keys.h"

namespace bullet_fem
{

/// A value that the viewer offers as a slider.
struct ViewerParameter
{
    std::string m_name, m_unit;  ///< UTF-8, for example "Young's modulus", "Pa"
    double m_value = 0;          ///< [m_unit], in [m_low, m_high]
    double m_low = 0, m_high = 1;
    bool m_logarithmic = false;  ///< for ranges over several powers of ten; m_low > 0 then
};

/// Work that goes on beside the simulation, shown as a bar.
struct ViewerProgress
{
    std::string m_text;  ///< what is done; empty: nothing is
    double m_share = 0;  ///< of it that is done [-], in [0, 1]
};

/// What a viewer shows and steers. All calls come from the thread that runs the viewer, none during another.
class ViewerSimulation
{
public:
    virtual ~ViewerSimulation() = default;

    /// Advances by `timeStep` [s].
    virtual void step() = 0;
    virtual double timeStep() const = 0;
    /// Sets the time that `scene` shows from now on: the time in steps from the end of the last one [-], in [-1, 0].
    virtual void setDrawnTime(double /*fraction*/) {}
    /// What is to be seen now; its camera is where the view starts. Used until the next call of anything here.
    virtual const PictureScene& scene() = 0;
    /// A number that changes where another thing is to be seen, at which the viewer takes the scene's camera anew.
    virtual int views() const { return 0; }
    /// Called in every frame, before the steps and also where there are none: takes what was done in the background.
    virtual void update() {}

    /// The mouse was pressed on what `ray` hits. True if something is held now; false leaves the mouse to the camera.
    virtual bool beginDrag(const PictureRay&) { return false; }
    /// What is held is wanted on `ray`, at its former distance from the eye.
    virtual void moveDrag(const PictureRay&) {}
    virtual void endDrag() {}

    /// Asked for in every frame, so that values which change by themselves are shown as they are.
    virtual std::vector<ViewerParameter> parameters() const { return {}; }
    /// Sets `parameters()[index]`. What it throws, if derived from std::exception, is shown to the user.
    virtual void setParameter(std::size_t /*index*/, double /*value*/) {}
    /// Lines of text under the sliders.
    virtual std::string status() const { return {}; }
    /// Lines below them of what has gone wrong since the start.
    virtual std::string warnings() const { return {}; }

    /// A key of the simulation's own was pressed while the mouse was on `cursor`. Says in `message` what was wrong.
    virtual void act(ViewerKey /*key*/, const PictureRay& /*cursor*/) {}
    /// Files were dropped there. Likewise.
    virtual void open(const std::vector<std::string>& /*files*/, const PictureRay& /*cursor*/) {}
    virtual ViewerProgress progress() const { return {}; }
    /// A sentence for the user, shown while it is not empty.
    virtual std::string message() const { return {}; }
};

}  // namespace bullet_fem

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

/// A value with a slider.
struct ViewerParameter
{
    std::string m_name, m_unit;  ///< UTF-8, for example "Young's modulus", "Pa"
    double m_value = 0;          ///< [m_unit], in [m_low, m_high]
    double m_low = 0, m_high = 1;
    bool m_logarithmic = false;  ///< for ranges over several powers of ten; m_low > 0 then
};

/// Background work, shown as a bar.
struct ViewerProgress
{
    std::string m_text;  ///< present activity; empty: none
    double m_share = 0;  ///< completed fraction [-], in [0, 1]
};

/// A simulation in a viewer. All calls come from the viewer's thread and never overlap.
class ViewerSimulation
{
public:
    virtual ~ViewerSimulation() = default;

    /// Advances by `timeStep` [s].
    virtual void step() = 0;
    virtual double timeStep() const = 0;
    /// Sets the time shown by `scene` from now on, in steps relative to the end of the last step [-], in [-1, 0].
    virtual void setDrawnTime(double /*fraction*/) {}
    /// The present picture; its camera is the initial view. Used until the next call of any function of this class.
    virtual const PictureScene& scene() = 0;
    /// A counter that changes when the view should be reset: the viewer then takes the scene's camera again.
    virtual int views() const { return 0; }
    /// Called in each frame before the steps, even if there are none: collects results of background work.
    virtual void update() {}

    /// The mouse was pressed on an object hit by the ray. Returns true if the simulation holds it; false leaves the
    /// mouse to the camera.
    virtual bool beginDrag(const PictureRay&) { return false; }
    /// Moves the held object to the ray, at its former distance from the eye.
    virtual void moveDrag(const PictureRay&) {}
    virtual void endDrag() {}

    /// Requested in each frame, so that values which change by themselves stay up to date.
    virtual std::vector<ViewerParameter> parameters() const { return {}; }
    /// Sets `parameters()[index]`. An exception derived from std::exception is shown to the user.
    virtual void setParameter(std::size_t /*index*/, double /*value*/) {}
    /// Lines of text under the sliders.
    virtual std::string status() const { return {}; }
    /// Lines below the status: warnings since the start.
    virtual std::string warnings() const { return {}; }

    /// A key of the simulation was pressed with the mouse on `cursor`. Errors go to `message`.
    virtual void act(ViewerKey /*key*/, const PictureRay& /*cursor*/) {}
    /// Files were dropped on `cursor`. Errors go to `message`.
    virtual void open(const std::vector<std::string>& /*files*/, const PictureRay& /*cursor*/) {}
    virtual ViewerProgress progress() const { return {}; }
    /// A message for the user, shown while it is not empty.
    virtual std::string message() const { return {}; }
};

}  // namespace bullet_fem

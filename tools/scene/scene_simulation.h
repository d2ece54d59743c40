// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <deque>
#include <memory>
#include <optional>

#include "tools/pictures/viewer_simulation.h"
#include "tools/scene/mesh_loading.h"
#include "tools/scene/scene_flags.h"
#include "tools/scene/scene_history.h"
#include "tools/scene/scene_hold.h"
#include "tools/scene/scene_painter.h"
#include "tools/scene/scene_sliders.h"

namespace bullet_fem
{

/// A scene with a ground only, for meshes opened by the user.
SceneDescription emptyScene();

struct SceneSimulationSettings
{
    /// Settings for opened files; its path is ignored, and its step and precision are those of the world.
    MeshRequest m_meshes;
    SceneHistorySettings m_history;
};

/// Interactive simulation of a scene: the mouse pulls soft bodies, sliders change materials and gravity, keys add
/// bodies, show forces and stress, and go back in time; opened files become bodies. It needs no window.
class SceneSimulation : public ViewerSimulation
{
public:
    /// The world must outlive this object.
    explicit SceneSimulation(SceneWorld& world, SceneSimulationSettings settings = {});

    void step() override;
    double timeStep() const override { return m_world.description().m_step; }
    void setDrawnTime(double fraction) override { m_drawnTime = fraction; }
    const PictureScene& scene() override;
    int views() const override { return m_views; }
    bool beginDrag(const PictureRay& ray) override { return m_hold.begin(ray); }
    void moveDrag(const PictureRay& ray) override { m_hold.move(ray); }
    void endDrag() override { m_hold.end(); }
    std::vector<ViewerParameter> parameters() const override { return m_sliders.parameters(); }
    void setParameter(std::size_t index, double value) override;
    std::string status() const override;
    std::string warnings() const override;
    void act(ViewerKey key, const PictureRay& cursor) override;
    void open(const std::vector<std::string>& files, const PictureRay& cursor) override;
    void update() override;
    ViewerProgress progress() const override;
    std::string message() const override { return m_message; }

    /// Opens a file and places the body above the centre of the initial view.
    void open(const std::string& file);
    const SceneHistory& history() const { return m_history; }

private:
    /// A file in the queue, with the position for its body.
    struct Waiting
    {
        std::string m_file;
        PictureRay m_cursor;
    };
    void addRigid(SceneShape::Kind kind, const PictureRay& cursor);
    void addLoaded();
    void startLoading();
    void cancelLoading();
    void showPast(bool shown, const char* otherwise);
    void changePictures(bool ScenePictures::*member);
    void rebuild();
    void measure();
    PictureRay middleRay() const;
    Vec3 up() const;
    Vec3 dropPlace(const PictureRay& cursor, double halfHeight, double gap) const;

    SceneWorld& m_world;
    SceneSimulationSettings m_settings;
    SceneSliders m_sliders;
    SceneHold m_hold;
    SceneHistory m_history;
    SceneFlags m_flags;
    std::optional<SceneFrames> m_frames;  // rebuilt when bodies are added
    std::optional<ScenePainter> m_painter;
    std::deque<Waiting> m_waiting;  // the first one is being loaded
    std::unique_ptr<MeshLoading> m_loading;
    std::vector<std::unique_ptr<MeshLoading>> m_givenUp;  // cancelled, threads still running
    std::string m_message;
    double m_size = 0;          // radius of the scene [m]; 0: not measured yet
    double m_drawnTime = 0;     // argument of SceneFrames::update
    double m_hottest = 1;       // upper limit of the stress legend [Pa]
    double m_largestForce = 0;  // upper limit of the force legend [N]
    int m_views = 0, m_added = 0;
};

}  // namespace bullet_fem

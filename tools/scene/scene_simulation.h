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

/// A ground and nothing on it, for meshes that are opened.
SceneDescription emptyScene();

struct SceneSimulationSettings
{
    /// How files become bodies; its path is not used, and its step and precision are the world's.
    MeshRequest m_meshes;
    SceneHistorySettings m_history;
};

/// A scene in a window: the mouse pulls soft bodies, sliders change materials and gravity, keys add bodies, show forces
/// and stress, and lead back in time; files that are opened become bodies. It knows no window: all that can be done in
/// one is done by its functions.
class SceneSimulation : public ViewerSimulation
{
public:
    /// The world must live longer.
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

    /// Opens a file above the middle of what is seen at the start.
    void open(const std::string& file);
    const SceneHistory& history() const { return m_history; }

private:
    /// A file that is waiting, or being loaded, and where it goes.
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
    std::optional<SceneFrames> m_frames;  // both anew when bodies come
    std::optional<ScenePainter> m_painter;
    std::deque<Waiting> m_waiting;  // the first is being loaded
    std::unique_ptr<MeshLoading> m_loading;
    std::vector<std::unique_ptr<MeshLoading>> m_givenUp;  // that have not noticed yet
    std::string m_message;
    double m_size = 0;          // radius of what the scene is about [m]; 0: to be measured
    double m_drawnTime = 0;     // of SceneFrames::update
    double m_hottest = 1;       // of the legend [Pa]
    double m_largestForce = 0;  // of the legend [N]
    int m_views = 0, m_added = 0;
};

}  // namespace bullet_fem

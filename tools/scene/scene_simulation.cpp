// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "tools/scene/scene_simulation.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <utility>

#include "BulletSoftBody/btSoftBody.h"
#include "bullet_fem/btFemRay.h"
#include "bullet_fem/btFemVectors.h"
#include "fem/common/reason.h"

namespace bullet_fem
{
namespace
{

constexpr double kAddedSize = 0.22;                 // edge of an added box over the scene's radius
constexpr double kAddedDensity = 500;               // of wood [kg/m3]
constexpr double kDropHeight = 1;                   // gap below an added body over its own size
constexpr double kFirstDropHeight = 0.1;            // gap for the first body of an empty scene
constexpr double kRoom = 1.6;                       // over the distance of a tight view: the first body may fall over
constexpr double kScaleFading = 2;                  // time constant for the decrease of legend ranges [s]
constexpr double kBeforeEye = 0.4;                  // fraction of the ray's length if it hits nothing
constexpr double kLongest = 20, kShortest = 0.005;  // sizes outside these limits suggest another unit than metres [m]
constexpr double kMebibyte = 1 << 20;
constexpr std::size_t kShownFlags = 6;  // listed in the panel

constexpr Vec3 kAddedColours[] = {
    {0.85, 0.50, 0.22}, {0.88, 0.72, 0.28}, {0.70, 0.30, 0.26}, {0.36, 0.55, 0.36}, {0.40, 0.48, 0.70}};

template <class... Values>
std::string formatted(const char* format, Values... values)
{
    char text[256];
    std::snprintf(text, sizeof text, format, values...);
    return text;
}

/// Bounding box of a baked body's nodes.
PictureBounds boundsOf(const BakedBody& body)
{
    PictureBounds box{body.m_positions.front(), body.m_positions.front()};
    for (const Vec3& x : body.m_positions)
        for (int i = 0; i < 3; ++i)
        {
            box.m_low[i] = std::min(box.m_low[i], x[i]);
            box.m_high[i] = std::max(box.m_high[i], x[i]);
        }
    return box;
}

std::string nameOf(const std::string& file)
{
    return std::filesystem::path(file).filename().string();
}

}  // namespace

SceneDescription emptyScene()
{
    SceneDescription scene;
    SceneRigidBody ground;
    ground.m_name = "ground";
    ground.m_shape.m_kind = SceneShape::Kind::plane;
    ground.m_shape.m_size = {0, 1, 0};
    scene.m_rigidBodies.push_back(ground);
    return scene;
}

SceneSimulation::SceneSimulation(SceneWorld& world, SceneSimulationSettings settings)
    : m_world(world),
      m_settings(std::move(settings)),
      m_sliders(world),
      m_hold(world),
      m_history(world, m_settings.m_history)
{
    m_settings.m_meshes.m_bake.m_step = world.description().m_step;
    m_settings.m_meshes.m_bake.m_singlePrecision = sizeof(btScalar) == sizeof(float);
    rebuild();
}

void SceneSimulation::step()
{
    m_history.step();
    m_flags.look(m_world);
    const double share = std::exp(-timeStep() / kScaleFading);
    m_hottest *= share;
    m_largestForce *= share;
}

const PictureScene& SceneSimulation::scene()
{
    m_frames->update(m_drawnTime);
    const SceneSnapshot snapshot = snapshotOf(m_world, *m_frames);
    const double wanted = m_world.description().m_pictures.m_hottest;
    m_hottest = std::max(m_hottest, hottestOf({snapshot}));  // at least 1 Pa
    m_painter->setHottest(wanted > 0 ? wanted : m_hottest);
    m_largestForce = std::max(m_largestForce, largestForceOf({snapshot}));
    if (m_largestForce > 0) m_painter->setLargestForce(m_largestForce);
    return m_painter->paint(snapshot);
}

/// Rebuilds frames and painter for the present bodies.
void SceneSimulation::rebuild()
{
    m_frames.emplace(m_world);
    if (m_size == 0) measure();
    m_painter.emplace(m_world, *m_frames, m_size);
    if (m_views > 0) m_painter->widenView(kRoom);
}

/// Measures the radius of the visible soft bodies; of all bodies if there are none.
void SceneSimulation::measure()
{
    PictureScene soft;
    for (std::size_t s = 0; s < m_frames->surfaces().size(); ++s)
    {
        if (m_world.softCount() > 0 && m_frames->bodyOf(int(s)) >= m_world.softCount()) continue;
        soft.m_meshes.emplace_back();
        soft.m_meshes.back().m_positions = m_frames->surfaces()[s].m_positions;
    }
    m_size = bounds(soft).radius();
}

void SceneSimulation::setParameter(std::size_t index, double value)
{
    if (m_sliders.set(index, value)) m_history.clear();
}

void SceneSimulation::act(ViewerKey key, const PictureRay& cursor)
{
    m_message.clear();
    try
    {
        switch (key)
        {
            case ViewerKey::box:
                return addRigid(SceneShape::Kind::box, cursor);
            case ViewerKey::ball:
                return addRigid(SceneShape::Kind::sphere, cursor);
            case ViewerKey::forces:
                m_largestForce = 0;
                return changePictures(&ScenePictures::m_forces);
            case ViewerKey::stress:
                m_hottest = 1;
                return changePictures(&ScenePictures::m_stress);
            case ViewerKey::earlier:
                m_hold.end();
                return showPast(m_history.earlier(), "Nothing earlier is kept.");
            case ViewerKey::later:
                m_hold.end();
                return showPast(m_history.later(), "This is the latest state: run, or make a step.");
            case ViewerKey::cancel:
                return cancelLoading();
            default:
                return;
        }
    }
    catch (const std::exception& error)
    {
        m_message = reasonOf(error);
    }
}

void SceneSimulation::showPast(bool shown, const char* otherwise)
{
    if (!shown) m_message = otherwise;
}

void SceneSimulation::changePictures(bool ScenePictures::*member)
{
    ScenePictures pictures = m_world.description().m_pictures;
    pictures.*member = !(pictures.*member);
    m_world.setPictures(pictures);
    rebuild();
}

Vec3 SceneSimulation::up() const
{
    const Vec3& gravity = m_world.description().m_gravity;
    const double length = norm(gravity);
    return length > 0 ? (-1 / length) * gravity : Vec3{0, 1, 0};
}

PictureRay SceneSimulation::middleRay() const
{
    const PictureCamera& camera = m_painter->camera();
    return {camera.m_eye, camera.m_eye + 4 * (camera.m_target - camera.m_eye)};
}

/// Position for the centre of a new body: above the ray's hit point, or, without a hit, at the scene's distance in
/// front of the eye.
Vec3 SceneSimulation::dropPlace(const PictureRay& cursor, double halfHeight, double gap) const
{
    const btVector3 from = bulletVector(cursor.m_from), to = bulletVector(cursor.m_to);
    btCollisionWorld::ClosestRayResultCallback rigid(from, to);
    m_world.world().rayTest(from, to, rigid);
    double fraction = rigid.hasHit() ? double(rigid.m_closestHitFraction) : 2;
    btFemRayHit hit;
    for (int i = 0; i < m_world.softCount(); ++i)
        if (btFemRay::test(&m_world.soft(i), from, to, &hit)) fraction = std::min(fraction, double(hit.m_fraction));
    const Vec3 along = cursor.m_to - cursor.m_from;
    if (fraction <= 1) return cursor.m_from + fraction * along + (halfHeight + gap) * up();
    return cursor.m_from + kBeforeEye * along;
}

void SceneSimulation::addRigid(SceneShape::Kind kind, const PictureRay& cursor)
{
    const double size = kAddedSize * m_size, radius = 0.5 * size;
    SceneRigidBody body;
    body.m_name = formatted("added %d", m_added + 1);
    body.m_shape.m_kind = kind;
    body.m_shape.m_size = {size, size, size};
    body.m_shape.m_radius = radius;
    const double volume =
        kind == SceneShape::Kind::box ? size * size * size : 4. / 3 * 3.14159265358979 * radius * radius * radius;
    body.m_mass = kAddedDensity * volume;
    body.m_pose.m_position = dropPlace(cursor, radius, kDropHeight * size);
    body.m_colour = kAddedColours[m_added % 5];
    m_world.add(body);
    ++m_added;
    m_history.clear();
    rebuild();
}

void SceneSimulation::open(const std::string& file)
{
    open(std::vector<std::string>{file}, middleRay());
}

void SceneSimulation::open(const std::vector<std::string>& files, const PictureRay& cursor)
{
    m_message.clear();
    for (const std::string& file : files) m_waiting.push_back({file, cursor});
    startLoading();
}

void SceneSimulation::startLoading()
{
    if (m_loading || m_waiting.empty()) return;
    MeshRequest request = m_settings.m_meshes;
    request.m_path = m_waiting.front().m_file;
    m_loading = std::make_unique<MeshLoading>(std::move(request));
}

/// Cancels without waiting: the thread may take a while to stop.
void SceneSimulation::cancelLoading()
{
    if (!m_loading) return;
    m_message = nameOf(m_waiting.front().m_file) + " was given up.";
    m_loading->cancel();
    m_givenUp.push_back(std::move(m_loading));
    m_waiting.pop_front();
    startLoading();
}

void SceneSimulation::update()
{
    m_givenUp.erase(
        std::remove_if(m_givenUp.begin(), m_givenUp.end(), [](const auto& loading) { return loading->finished(); }),
        m_givenUp.end());
    if (!m_loading || !m_loading->finished()) return;
    try
    {
        addLoaded();
    }
    catch (const std::exception& error)
    {
        m_message = reasonOf(error);
    }
    m_loading.reset();
    m_waiting.pop_front();
    startLoading();
}

void SceneSimulation::addLoaded()
{
    const BakedBody baked = m_loading->take();
    const PictureBounds box = boundsOf(baked);
    const Vec3 edges = box.m_high - box.m_low;
    const double halfHeight = 0.5 * std::abs(dot(edges, up())), length = std::max({edges.x, edges.y, edges.z});
    const bool first = m_world.softCount() == 0;
    SceneSoftBody body;
    body.m_name = nameOf(m_waiting.front().m_file);
    const PictureRay down{3 * length * up(), -3 * length * up()};
    const Vec3 place = first ? dropPlace(down, halfHeight, kFirstDropHeight * length)
                             : dropPlace(m_waiting.front().m_cursor, halfHeight, 0.5 * kDropHeight * length);
    body.m_pose.m_position = place - box.centre();
    m_world.add(body, baked);
    m_sliders.update();
    m_history.clear();
    if (first)
    {
        m_size = 0;
        ++m_views;
    }
    rebuild();
    m_message = formatted("%d tetrahedra, %.3g m long: ", baked.m_model->mesh().tetCount(), length) + body.m_name;
    if (length > kLongest || length < kShortest)
        m_message += ". If its unit is not the metre, give --scale, such as 0.001 for millimetres.";
}

ViewerProgress SceneSimulation::progress() const
{
    if (!m_loading) return {};
    std::string text = nameOf(m_loading->request().m_path) + ": " + m_loading->stage();
    if (m_waiting.size() > 1) text += formatted(", %d more to come", static_cast<int>(m_waiting.size()) - 1);
    return {text, m_loading->share()};
}

std::string SceneSimulation::status() const
{
    int tets = 0, contacts = 0;
    for (int i = 0; i < m_world.softCount(); ++i)
    {
        const btFemStepReport& report = m_world.fem().stepReport(&m_world.soft(i));
        tets += report.m_tets;
        contacts += report.m_contacts;
    }
    const std::string now = formatted("%.2f s, %d tetrahedra, %d contacts\n", m_world.time(), tets, contacts);
    const double used = double(m_history.bytes()) / kMebibyte,
                 most = double(m_history.settings().m_maxBytes) / kMebibyte;
    return now + (m_history.isPast() ? formatted("Back in time: %.2f s of %.2f s", m_world.time(), m_history.until())
                                     : formatted("Kept since %.2f s: %.1f of %.0f MiB", m_history.since(), used, most));
}

// Newest first, because space is limited.
std::string SceneSimulation::warnings() const
{
    std::vector<SceneFlag> flags = m_flags.all();
    std::reverse(flags.begin(), flags.end());
    std::string lines;
    for (std::size_t k = 0; k < flags.size() && k < kShownFlags; ++k)
        lines +=
            (lines.empty() ? "" : "\n") + flags[k].m_body + ": " + flags[k].m_text->m_title + ", " + flags[k].when();
    if (flags.size() > kShownFlags) lines += "\n" + formatted("and %d before", int(flags.size() - kShownFlags));
    return lines;
}

}  // namespace bullet_fem

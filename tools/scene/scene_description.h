// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <limits>
#include <map>
#include <string>
#include <vector>

#include "bullet_fem/fem/common/vec3.h"
#include "bullet_fem/fem/mesh/material.h"

/// A scene as its file tells it (docs/scene.schema.json), in SI units: plain values, before any Bullet object is made.
namespace bullet_fem
{

/// Where a body starts.
struct ScenePose
{
    Vec3 m_position;       ///< [m]
    Vec3 m_axis{0, 1, 0};  ///< of its rotation about its own origin; not 0
    double m_angle = 0;    ///< [rad]
};

/// A value over time, straight between its points.
template <class Value>
struct SceneCurveOf
{
    struct Point
    {
        double m_time;  ///< [s]
        Value m_value;  ///< in the unit of what it is
    };
    std::vector<Point> m_points;  ///< by time, at least one

    Value at(double time) const
    {
        std::size_t k = 0;  // the first point after it
        while (k < m_points.size() && m_points[k].m_time <= time) ++k;
        if (k == 0 || k == m_points.size()) return m_points[k == 0 ? 0 : k - 1].m_value;
        const Point &a = m_points[k - 1], &b = m_points[k];
        return a.m_value + (time - a.m_time) / (b.m_time - a.m_time) * (b.m_value - a.m_value);
    }
};
using SceneCurve = SceneCurveOf<double>;
using SceneVectorCurve = SceneCurveOf<Vec3>;

/// Picks the nodes of a soft body that start in it.
struct SceneBox
{
    Vec3 m_low, m_high;  ///< corners in the world [m]

    bool contains(const Vec3& x) const
    {
        for (int i = 0; i < 3; ++i)
            if (x[i] < m_low[i] || x[i] > m_high[i]) return false;
        return true;
    }
};

/// Where a soft body's elements come from.
struct SceneMesh
{
    enum class Kind
    {
        box,         ///< a block, centred on its origin
        sphere,      ///< a ball, likewise
        cylinder,    ///< about y, likewise
        surface,     ///< a cage around a surface file
        tetrahedra,  ///< a mesh file
        baked        ///< a .bfem file, with its material and pins
    };
    Kind m_kind = Kind::box;
    std::string m_path;              ///< of a file, found beside the scene
    Vec3 m_size{1, 1, 1};            ///< of a box [m], > 0
    double m_radius = 0.5;           ///< of a sphere or cylinder [m], > 0
    double m_height = 1;             ///< of a cylinder [m], > 0
    std::vector<SceneBox> m_holes;   ///< in it, about its middle: elements whose middle is in one are left out
    double m_cellSize = 0;           ///< of a box, sphere, cylinder or cage [m]; 0: by m_tets
    int m_tets = 2000;               ///< about so many elements in these
    double m_cellsAcross = 0;        ///< of thin parts of a cage [-], in [0.5, 8]; 0: cells are alike
    int m_mostLevels = 3;            ///< most halvings of a graded cage's cells
    double m_scale = 1;              ///< times the file's positions [-], > 0
    bool m_surfaceCollides = false;  ///< of a surface: what collides, in place of its cage
};

/// When a weld breaks, and how stiff it is (docs/materials.md, Breaking).
struct SceneWeldStrength
{
    static constexpr double kNever = std::numeric_limits<double>::infinity();  ///< a limit that nothing reaches
    double m_breakForce = kNever;                                              ///< of all of the weld [N], > 0
    double m_breakStress = kNever;   ///< tension and shear at a node [Pa], > 0
    double m_breakStretch = kNever;  ///< distance of a node from its partner [m], > 0
    double m_compliance = 0;         ///< of a layer of glue [m/Pa], in [0, 1]
};

/// Whether a soft body is cut into Voronoi cells, which are welded to each other.
struct ScenePieces
{
    int m_cells = 0;  ///< 0: it is not cut
    int m_seed = 1;   ///< of where they are
    SceneWeldStrength m_strength;
};

/// Whether a soft body splits along faces of its elements (docs/materials.md, Splitting).
struct SceneFracture
{
    double m_tension = 0;      ///< that it bears [Pa]; 0: it does not split
    int m_mostCracks = 1;      ///< that begin or go on in a step, >= 1
    bool m_partsTouch = true;  ///< each other, once it has fallen into parts
};

struct SceneSoftBody
{
    std::string m_name;
    SceneMesh m_mesh;
    ScenePose m_pose;
    Vec3 m_velocity;                            ///< [m/s]
    Material m_material;                        ///< of baked bodies: the file's
    std::map<int, Material> m_regionMaterials;  ///< by the labels of a mesh file, in place of m_material
    double m_friction = 0.5;                    ///< [-]; times the other body's
    double m_restitution = 0;                   ///< [-]; times the other body's
    bool m_selfContact = false;
    Vec3 m_colour{0.86, 0.64, 0.42};  ///< sRGB
    std::vector<SceneBox> m_pins;     ///< nodes that stand still
    ScenePieces m_pieces;
    SceneFracture m_fracture;
    std::string m_whole;  ///< of a piece in a SceneWorld: the name of the body that was cut, by which scenes call it
};

/// Ties two soft bodies by the faces that they have in common at the start.
struct SceneWeld
{
    std::string m_a, m_b;  ///< names; of bodies in pieces each piece is meant
    SceneWeldStrength m_strength;
    double m_reach = 0;  ///< how far apart corners of faces in common are at most [m]; 0: .001 of the shorter mean edge
};

struct SceneShape
{
    enum class Kind
    {
        plane,     ///< through the body's position, m_size its normal
        box,       ///< m_size its edges
        sphere,    ///< m_radius
        cylinder,  ///< about y, m_radius and m_height
        capsule    ///< about y, m_radius, and m_height between the middles of its caps
    };
    Kind m_kind = Kind::box;
    Vec3 m_size{1, 1, 1};                 ///< [m]
    double m_radius = 0.5, m_height = 1;  ///< [m], > 0
};

struct SceneRigidBody
{
    std::string m_name;
    SceneShape m_shape;
    double m_mass = 0;  ///< [kg]; 0: it stands still, or moves as m_velocity and m_spin say
    ScenePose m_pose;
    SceneVectorCurve m_velocity{{{0, {}}}}, m_spin{{{0, {}}}};  ///< [m/s], [rad/s]; with a mass: at the start
    double m_friction = 1, m_restitution = 0;                   ///< [-]
    Vec3 m_colour{0.55, 0.60, 0.68};                            ///< sRGB
};

struct SceneConstraint
{
    enum class Kind
    {
        anchor,  ///< nodes of a soft body in m_box, to a rigid one
        point,   ///< a ball joint at m_pivot, between two rigid bodies or one and the world
        hinge,   ///< likewise, about m_axis, with a motor if m_max > 0
        slider   ///< likewise, along m_axis
    };
    Kind m_kind = Kind::anchor;
    std::string m_a, m_b;  ///< names; of joints m_b may be empty: the world
    SceneBox m_box;
    Vec3 m_pivot, m_axis{0, 1, 0};  ///< in the world at the start [m]
    SceneCurve m_speed{{{0, 0}}};   ///< of the motor [rad/s], of a slider's [m/s]
    double m_max = 0;               ///< torque of the motor at most [N m], of a slider's its force [N]
};

/// A force on a body while time is in [m_from, m_to).
struct SceneForce
{
    std::string m_body;
    bool m_everywhere = true;  ///< on all nodes, by mass; else on those that start in m_box, in equal parts
    SceneBox m_box;
    Vec3 m_force;                    ///< of all together [N]
    double m_from = 0, m_to = 1e30;  ///< [s]
};

/// Pulls a soft body to a place while time is in [m_from, m_to), as a hand does.
struct SceneSpring
{
    std::string m_body;
    Vec3 m_at;                              ///< it holds the point of the surface that starts nearest to this [m]
    SceneVectorCurve m_target;              ///< [m]
    double m_stiffness = 0, m_damping = 0;  ///< [N/m], [N s/m]
    double m_max = 0;                       ///< force at most [N]; 0: no limit
    double m_from = 0, m_to = 1e30;         ///< [s]
};

/// What drives a soft body from within (docs/actuation.md).
struct SceneActuator
{
    enum class Kind
    {
        chamber,  ///< of one or all cavities
        cable,    ///< through the nodes that start nearest to places
        fibres,
        expansion
    };
    Kind m_kind = Kind::chamber;
    std::string m_body;
    SceneCurve m_value;          ///< pressure [Pa], tension [N] or rest length [m], activation [Pa], strain [-]
    int m_cavity = -1;           ///< of a chamber: which, from 0; -1: all
    double m_sealedFrom = 1e30;  ///< of a chamber: it keeps its gas from then on [s]
    std::vector<Vec3> m_points;  ///< of a cable, in the world at the start [m]
    double m_stiffness = 0;      ///< of a cable [N/m]; 0: it has a tension
    bool m_everywhere = true;    ///< of fibres and expansion: in all elements; else those whose middle starts in m_box
    SceneBox m_box;
    Vec3 m_direction{1, 0, 0};  ///< of fibres, in the world at the start
};

/// Tells the force and moment by which a soft body is held.
struct SceneSensor
{
    std::string m_name;
    std::string m_body;
    std::string m_to;          ///< the rigid body whose anchors count; empty: pinned nodes do
    bool m_everywhere = true;  ///< all of the body's pinned nodes; else those that start in m_box
    SceneBox m_box;
    bool m_placed = false;  ///< m_about is given; else it is the mean place at the start of the nodes that are held
    Vec3 m_about;           ///< of moments [m]
};

struct SceneCamera
{
    bool m_placed = false;          ///< m_eye and m_target are given; else the scene is framed from m_direction
    Vec3 m_direction{1, 0.6, 1.6};  ///< from the scene to the eye
    Vec3 m_eye, m_target;           ///< [m]
    double m_fieldOfView = 0.6;     ///< [rad]
};

/// What pictures show.
struct ScenePictures
{
    int m_width = 1280, m_height = 720;  ///< [pixels]
    bool m_stress = false;               ///< colours are von Mises stress
    double m_hottest = 0;   ///< of the last colour [Pa]; 0: 98 % of the nodes are below, in the hottest frame
    bool m_forces = false;  ///< arrows of contact forces
    bool m_wireframe = false;
};

struct SceneDescription
{
    std::string m_folder;  ///< where its files are looked for
    std::string m_title;
    Vec3 m_gravity{0, -9.81, 0};  ///< [m/s2]; up is opposite, or y
    double m_step = 1.0 / 60;     ///< [s]
    double m_seconds = 4;         ///< to simulate
    double m_framesPerSecond = 30;
    bool m_coupled = true;  ///< rigid and soft bodies are solved together (btFemConstraintSolver)
    double m_tolerance = 1e-3, m_contactTolerance = 3e-3;
    int m_threads = 1;
    std::vector<SceneSoftBody> m_softBodies;
    std::vector<SceneRigidBody> m_rigidBodies;
    std::vector<SceneConstraint> m_constraints;
    std::vector<SceneWeld> m_welds;
    std::vector<SceneForce> m_forces;
    std::vector<SceneSpring> m_springs;
    std::vector<SceneActuator> m_actuators;
    std::vector<SceneSensor> m_sensors;
    SceneCamera m_camera;
    ScenePictures m_pictures;
};

}  // namespace bullet_fem

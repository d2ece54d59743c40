// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <limits>
#include <map>
#include <string>
#include <vector>

#include "bullet_fem/fem/common/vec3.h"
#include "bullet_fem/fem/mesh/material.h"

/// A scene as described by its file (docs/scene.schema.json), in SI units: plain values without Bullet objects.
namespace bullet_fem
{

/// Initial pose of a body.
struct ScenePose
{
    Vec3 m_position;       ///< [m]
    Vec3 m_axis{0, 1, 0};  ///< of the rotation about the body's origin; not 0
    double m_angle = 0;    ///< [rad]
};

/// A piecewise linear function of time.
template <class Value>
struct SceneCurveOf
{
    struct Point
    {
        double m_time;  ///< [s]
        Value m_value;  ///< in the unit of the quantity
    };
    std::vector<Point> m_points;  ///< by ascending time, at least one

    Value at(double time) const
    {
        std::size_t k = 0;  // first point after the time
        while (k < m_points.size() && m_points[k].m_time <= time) ++k;
        if (k == 0 || k == m_points.size()) return m_points[k == 0 ? 0 : k - 1].m_value;
        const Point &a = m_points[k - 1], &b = m_points[k];
        return a.m_value + (time - a.m_time) / (b.m_time - a.m_time) * (b.m_value - a.m_value);
    }
};
using SceneCurve = SceneCurveOf<double>;
using SceneVectorCurve = SceneCurveOf<Vec3>;

/// A box that selects nodes of a soft body by their initial positions.
struct SceneBox
{
    Vec3 m_low, m_high;  ///< corners in world coordinates [m]

    bool contains(const Vec3& x) const
    {
        for (int i = 0; i < 3; ++i)
            if (x[i] < m_low[i] || x[i] > m_high[i]) return false;
        return true;
    }
};

/// Source of a soft body's elements.
struct SceneMesh
{
    enum class Kind
    {
        box,         ///< a block, centred at the body's origin
        sphere,      ///< a ball, centred at the body's origin
        cylinder,    ///< about y, centred at the body's origin
        surface,     ///< a cage around the surface of a file
        tetrahedra,  ///< a tetrahedral mesh file
        baked        ///< a .bfem file with its own material and pins
    };
    Kind m_kind = Kind::box;
    std::string m_path;              ///< of the file, relative to the scene file
    Vec3 m_size{1, 1, 1};            ///< of a box [m], > 0
    double m_radius = 0.5;           ///< of a sphere or cylinder [m], > 0
    double m_height = 1;             ///< of a cylinder [m], > 0
    std::vector<SceneBox> m_holes;   ///< boxes relative to the centre: elements with their centre in one are removed
    double m_cellSize = 0;           ///< of a box, sphere, cylinder or cage [m]; 0: by m_tets
    int m_tets = 2000;               ///< approximate number of elements in these
    double m_cellsAcross = 0;        ///< in thin parts of a cage [-], in [0.5, 8]; 0: uniform cells
    int m_mostLevels = 3;            ///< maximum number of halvings in a graded cage
    double m_scale = 1;              ///< factor on the file's positions [-], > 0
    bool m_surfaceCollides = false;  ///< the surface collides instead of its cage
};

/// Limits at which a weld breaks, and its compliance (docs/materials.md, Breaking).
struct SceneWeldStrength
{
    static constexpr double kNever = std::numeric_limits<double>::infinity();  ///< no limit
    double m_breakForce = kNever;                                              ///< total force of the weld [N], > 0
    double m_breakStress = kNever;   ///< tension and shear at a node [Pa], > 0
    double m_breakStretch = kNever;  ///< distance of a node from its partner [m], > 0
    double m_compliance = 0;         ///< of the glue layer [m/Pa], in [0, 1]
};

/// Division of a soft body into Voronoi cells that are welded to each other.
struct ScenePieces
{
    int m_cells = 0;  ///< number of cells; 0: no division
    int m_seed = 1;   ///< random seed of the cell positions
    SceneWeldStrength m_strength;
};

/// Splitting of a soft body along faces of its elements (docs/materials.md, Splitting).
struct SceneFracture
{
    double m_tension = 0;      ///< tensile strength [Pa]; 0: no splitting
    int m_mostCracks = 1;      ///< maximum number of cracks that start or grow in a step, >= 1
    bool m_partsTouch = true;  ///< parts collide with each other after separation
};

struct SceneSoftBody
{
    std::string m_name;
    SceneMesh m_mesh;
    ScenePose m_pose;
    Vec3 m_velocity;                            ///< [m/s]
    Material m_material;                        ///< ignored for baked bodies, which use the file's
    std::map<int, Material> m_regionMaterials;  ///< by region labels of a mesh file, instead of m_material
    double m_friction = 0.5;                    ///< [-]; multiplied by the other body's
    double m_restitution = 0;                   ///< [-]; multiplied by the other body's
    bool m_selfContact = false;
    Vec3 m_colour{0.86, 0.64, 0.42};  ///< sRGB
    std::vector<SceneBox> m_pins;     ///< fixed nodes
    ScenePieces m_pieces;
    SceneFracture m_fracture;
    std::string m_whole;  ///< for a fragment in a SceneWorld: name of the whole body, by which scenes refer to it
};

/// Welds two soft bodies along faces that coincide initially.
struct SceneWeld
{
    std::string m_a, m_b;  ///< names; if a body is divided, all its fragments are meant
    SceneWeldStrength m_strength;
    double m_reach = 0;  ///< tolerance for coinciding corners of faces [m]; 0: 0.001 of the shorter mean edge
};

struct SceneShape
{
    enum class Kind
    {
        plane,     ///< through the body's position; m_size is its normal
        box,       ///< m_size is its edge lengths
        sphere,    ///< m_radius
        cylinder,  ///< about y, m_radius and m_height
        capsule    ///< about y, m_radius, and m_height between the centres of its caps
    };
    Kind m_kind = Kind::box;
    Vec3 m_size{1, 1, 1};                 ///< [m]
    double m_radius = 0.5, m_height = 1;  ///< [m], > 0
};

struct SceneRigidBody
{
    std::string m_name;
    SceneShape m_shape;
    double m_mass = 0;  ///< [kg]; 0: static, or kinematic with m_velocity and m_spin
    ScenePose m_pose;
    SceneVectorCurve m_velocity{{{0, {}}}}, m_spin{{{0, {}}}};  ///< [m/s], [rad/s]; with a mass: initial values
    double m_friction = 1, m_restitution = 0;                   ///< [-]
    Vec3 m_colour{0.55, 0.60, 0.68};                            ///< sRGB
};

struct SceneConstraint
{
    enum class Kind
    {
        anchor,  ///< nodes of a soft body in m_box to a rigid body
        point,   ///< a ball joint at m_pivot, between two rigid bodies or one and the world
        hinge,   ///< rotation about m_axis through m_pivot, with a motor if m_max > 0
        slider   ///< translation along m_axis, with a motor if m_max > 0
    };
    Kind m_kind = Kind::anchor;
    std::string m_a, m_b;  ///< names; an empty m_b of a joint is the world
    SceneBox m_box;
    Vec3 m_pivot, m_axis{0, 1, 0};  ///< in initial world coordinates [m]
    SceneCurve m_speed{{{0, 0}}};   ///< of the motor of a hinge [rad/s] or slider [m/s]
    double m_max = 0;               ///< maximum torque of a hinge's motor [N m], force of a slider's [N]
};

/// A force on a body during [m_from, m_to).
struct SceneForce
{
    std::string m_body;
    bool m_everywhere = true;  ///< distributed over all nodes by mass; else equally over nodes that start in m_box
    SceneBox m_box;
    Vec3 m_force;                    ///< total force [N]
    double m_from = 0, m_to = 1e30;  ///< [s]
};

/// A spring that pulls a soft body to a target, as a hand does, during [m_from, m_to).
struct SceneSpring
{
    std::string m_body;
    Vec3 m_at;                              ///< attached to the surface point that is initially nearest [m]
    SceneVectorCurve m_target;              ///< [m]
    double m_stiffness = 0, m_damping = 0;  ///< [N/m], [N s/m]
    double m_max = 0;                       ///< maximum force [N]; 0: no limit
    double m_from = 0, m_to = 1e30;         ///< [s]
};

/// An internal actuator of a soft body (docs/actuation.md).
struct SceneActuator
{
    enum class Kind
    {
        chamber,  ///< gas in one cavity or in all
        cable,    ///< through the nodes that are initially nearest to m_points
        fibres,
        expansion
    };
    Kind m_kind = Kind::chamber;
    std::string m_body;
    SceneCurve m_value;          ///< pressure [Pa], tension [N] or rest length [m], activation [Pa], strain [-]
    int m_cavity = -1;           ///< index of a chamber's cavity, from 0; -1: all
    double m_sealedFrom = 1e30;  ///< the chamber is sealed from this time on [s]
    std::vector<Vec3> m_points;  ///< of a cable, in initial world coordinates [m]
    double m_stiffness = 0;      ///< of a cable [N/m]; 0: the cable has a given tension
    bool m_everywhere = true;  ///< fibres and expansion act in all elements; else in those whose centre starts in m_box
    SceneBox m_box;
    Vec3 m_direction{1, 0, 0};  ///< of fibres, in initial world coordinates
};

/// Measures the force and moment that hold a soft body.
struct SceneSensor
{
    std::string m_name;
    std::string m_body;
    std::string m_to;          ///< rigid body whose anchors are measured; empty: pinned nodes
    bool m_everywhere = true;  ///< all pinned nodes of the body; else those that start in m_box
    SceneBox m_box;
    bool m_placed = false;  ///< m_about is given; else it is the mean initial position of the held nodes
    Vec3 m_about;           ///< reference point of moments [m]
};

struct SceneCamera
{
    bool m_placed = false;          ///< m_eye and m_target are given; else the view is framed from m_direction
    Vec3 m_direction{1, 0.6, 1.6};  ///< from the scene to the eye
    Vec3 m_eye, m_target;           ///< [m]
    double m_fieldOfView = 0.6;     ///< [rad]
};

/// Content of pictures.
struct ScenePictures
{
    int m_width = 1280, m_height = 720;  ///< [pixels]
    bool m_stress = false;               ///< colours show von Mises stress
    /// Stress of the last colour [Pa]; 0: the 98 % quantile over nodes, of the frame with the largest one.
    double m_hottest = 0;
    bool m_forces = false;  ///< shows contact forces as arrows
    bool m_wireframe = false;
};

struct SceneDescription
{
    std::string m_folder;  ///< folder of files named in the scene
    std::string m_title;
    Vec3 m_gravity{0, -9.81, 0};  ///< [m/s2]; up is the opposite direction, or y without gravity
    double m_step = 1.0 / 60;     ///< [s]
    double m_seconds = 4;         ///< simulated time [s]
    double m_framesPerSecond = 30;
    bool m_coupled = true;  ///< monolithic coupling of rigid and soft bodies (btFemConstraintSolver)
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

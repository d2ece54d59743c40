// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// The scene of the browser page: a baked body on the ground, a ball, a box, and the mouse's spring. One scene with a
// plain C interface for JavaScript; SI units. Functions documented to return 0 on failure leave the reason in
// scene_error().
#pragma once

#ifdef __EMSCRIPTEN__
#include <emscripten.h>
#define SCENE_CALL EMSCRIPTEN_KEEPALIVE  // exports functions that no C++ code calls
#else
#define SCENE_CALL
#endif

extern "C"
{
    /// Restarts the scene with the body of a .bfem file in memory; null: with the present body. Returns 0 if the bytes
    /// are not such a file.
    SCENE_CALL int scene_open(const unsigned char* bytes, int count);
    /// Message of the last failed call.
    SCENE_CALL const char* scene_error();
    /// Young's modulus [Pa], stiffness damping beta [s], gravity [m/s2] and time step [s], from the next step on and
    /// for later scenes. Returns 0, without any change, if a value is out of range.
    SCENE_CALL int scene_set(double young, double damping, double gravity, double step);
    /// 1: fixes the body's lowest nodes, its feet, where they are; 0: frees them, as they are at first. Returns 0 on
    /// failure.
    SCENE_CALL int scene_hold_feet(int held);
    SCENE_CALL void scene_step();

    /// Takes hold of the first point of the body on the segment between two points [m]. Returns 0, without an error, if
    /// the segment misses the body or meets another body first.
    SCENE_CALL int scene_pick(double x0, double y0, double z0, double x1, double y1, double z1);
    /// Sets the point to which the spring pulls the held point [m]. Returns 0 if nothing is held or the point is not
    /// finite.
    SCENE_CALL int scene_drag(double x, double y, double z);
    SCENE_CALL void scene_release();
    /// Position of the held point [m]: 3 numbers, valid until the next call; null if nothing is held.
    SCENE_CALL const float* scene_held();

    // The surface that follows the body. The arrays stay valid until the next call of a function outside this group.
    SCENE_CALL int scene_vertex_count();
    SCENE_CALL const float* scene_vertices();  ///< per vertex position [m] and unit normal, 6 numbers
    SCENE_CALL int scene_triangle_count();
    SCENE_CALL const int* scene_triangles();  ///< 3 vertices each, anticlockwise from outside

    SCENE_CALL int scene_rigid_count();
    SCENE_CALL int scene_rigid_is_ball(int body);  ///< 1: a ball, 0: a box
    /// 4 x 4 matrix by columns, from a ball of radius 1 or a box of half edges 1 to the world [m]; valid until the next
    /// call.
    SCENE_CALL const float* scene_rigid_pose(int body);

    SCENE_CALL int scene_tets();
    SCENE_CALL int scene_iterations();  ///< of free motion in the last step
    SCENE_CALL int scene_contacts();    ///< contact points in the last step
    SCENE_CALL int scene_asleep();      ///< 1: the body sleeps
    SCENE_CALL double scene_mass();     ///< of the body [kg]
    SCENE_CALL double scene_fastest();  ///< speed of the body's fastest node [m/s]
    /// Centre of mass of the body [m]: 3 numbers, valid until the next call.
    SCENE_CALL const float* scene_centre();
}

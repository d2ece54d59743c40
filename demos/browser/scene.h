// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// The scene of the browser page: a baked body that stands on the ground, a ball and a box, and the mouse's spring.
// Plain C functions, so that JavaScript can call them; SI units; there is one scene. What returns 0 and says so failed:
// then scene_error() tells why.
#pragma once

#ifdef __EMSCRIPTEN__
#include <emscripten.h>
#define SCENE_CALL EMSCRIPTEN_KEEPALIVE  // exported, though nothing in C++ calls it
#else
#define SCENE_CALL
#endif

extern "C"
{
    /// Starts the scene anew with the body of a .bfem file that lies in memory; null: with the one that it had. Returns
    /// 0 if the bytes are no such file.
    SCENE_CALL int scene_open(const unsigned char* bytes, int count);
    /// Of the call that failed last.
    SCENE_CALL const char* scene_error();
    /// Young's modulus [Pa], stiffness damping beta [s], gravity [m/s2] and time step [s]; from the next step on, and
    /// for later scenes. Returns 0 if one is out of its range: then nothing has changed.
    SCENE_CALL int scene_set(double young, double damping, double gravity, double step);
    /// 1: the body's feet, its lowest nodes, stay where they are now; 0: it is free, as it is at first. Returns 0 if it
    /// failed.
    SCENE_CALL int scene_hold_feet(int held);
    SCENE_CALL void scene_step();

    /// Takes hold of the point of the body that a ray between two points [m] meets first. Returns 0, without an error,
    /// if it meets none, or something else before.
    SCENE_CALL int scene_pick(double x0, double y0, double z0, double x1, double y1, double z1);
    /// Where the spring pulls that point [m]. Returns 0 if nothing is held, or the place is not finite.
    SCENE_CALL int scene_drag(double x, double y, double z);
    SCENE_CALL void scene_release();
    /// Where the held point is [m]: 3 numbers, valid until the next call; null if nothing is held.
    SCENE_CALL const float* scene_held();

    // The surface that follows the body. The arrays are valid until the next call of a function that is not one of
    // these.
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
    SCENE_CALL int scene_iterations();  ///< of the last step's free motion
    SCENE_CALL int scene_contacts();    ///< points of the last step
    SCENE_CALL int scene_asleep();      ///< 1: the body sleeps
    SCENE_CALL double scene_mass();     ///< of the body [kg]
    SCENE_CALL double scene_fastest();  ///< speed of the body's fastest node [m/s]
    /// Centre of mass of the body [m]: 3 numbers, valid until the next call.
    SCENE_CALL const float* scene_centre();
}

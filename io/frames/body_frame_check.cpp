// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "io/frames/body_frame_check.h"

#include <cfloat>
#include <cmath>

#include "fem/common/message.h"

namespace bullet_fem
{
namespace
{

/// Function and body named in error messages.
struct Blame
{
    std::string m_caller;
    int m_body;

    template <typename... Parts>
    [[noreturn]] void operator()(const Parts&... parts) const
    {
        reject(m_caller, ": body ", m_body, ": ", parts...);
    }
};

bool isSingle(double d)
{
    return std::fabs(d) <= FLT_MAX;
}

bool isSingle(const Vec3& v)
{
    return isSingle(v.x) && isSingle(v.y) && isSingle(v.z);
}

bool isSingle(const Stress& s)
{
    return isSingle(s.xx) && isSingle(s.yy) && isSingle(s.zz) && isSingle(s.xy) && isSingle(s.yz) && isSingle(s.xz);
}

template <class Value>
void checkValues(const Blame& blame, const char* what, const char* of, const std::vector<Value>& values)
{
    for (std::size_t i = 0; i < values.size(); ++i)
        if (!isSingle(values[i])) blame("the ", what, " of ", of, " ", i, " is not finite in single precision");
}

template <class Value>
void checkNodeValues(const Blame& blame, const char* what, const char* many, const BodyFrame& body,
                     const std::vector<Value>& values)
{
    if (!values.empty() && values.size() != body.m_positions.size())
        blame(values.size(), " ", many, " for ", body.m_positions.size(), " vertices; give as many, or none");
    checkValues(blame, what, "vertex", values);
}

template <class Value>
void checkTetCount(const Blame& blame, const char* many, const BodyFrame& body, const std::vector<Value>& values)
{
    if (!values.empty() && values.size() != body.m_tets.size())
        blame(values.size(), " ", many, " for ", body.m_tets.size(), " tetrahedra; give as many, or none");
}

template <class Value>
void checkTetValues(const Blame& blame, const char* what, const char* many, const BodyFrame& body,
                    const std::vector<Value>& values)
{
    checkTetCount(blame, many, body, values);
    checkValues(blame, what, "tetrahedron", values);
}

template <class Cell>
void checkCells(const Blame& blame, const char* what, const std::vector<Cell>& cells, std::size_t vertices)
{
    for (std::size_t c = 0; c < cells.size(); ++c)
        for (const int v : cells[c])
            if (v < 0 || static_cast<std::size_t>(v) >= vertices)
                blame(what, " ", c, " uses vertex ", v, ", which is not in [0, ", vertices, ")");
}

}  // namespace

void checkTime(const char* caller, double time)
{
    if (!std::isfinite(time)) reject(caller, ": the time is ", time, " s; it must be finite");
}

void checkFrame(const char* caller, const std::vector<BodyFrame>& bodies)
{
    for (std::size_t b = 0; b < bodies.size(); ++b)
    {
        const BodyFrame& body = bodies[b];
        const Blame blame = {caller, static_cast<int>(b)};
        checkValues(blame, "position", "vertex", body.m_positions);
        checkCells(blame, "tetrahedron", body.m_tets, body.m_positions.size());
        checkCells(blame, "triangle", body.m_triangles, body.m_positions.size());
        checkNodeValues(blame, "displacement", "displacements", body, body.m_displacement);
        checkNodeValues(blame, "velocity", "velocities", body, body.m_velocity);
        checkNodeValues(blame, "contact force", "contact forces", body, body.m_contactForce);
        checkNodeValues(blame, "reaction force", "reaction forces", body, body.m_reactionForce);
        checkNodeValues(blame, "stress", "stresses", body, body.m_nodeStress);
        checkTetValues(blame, "stress", "stresses", body, body.m_tetStress);
        checkTetValues(blame, "plastic strain", "plastic strains", body, body.m_tetPlasticStrain);
        checkTetValues(blame, "activation", "activations", body, body.m_tetActivation);
        checkTetCount(blame, "regions", body, body.m_tetRegion);
    }
}

}  // namespace bullet_fem

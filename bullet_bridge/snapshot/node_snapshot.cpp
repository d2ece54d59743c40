// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "bullet_bridge/snapshot/node_snapshot.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "BulletSoftBody/btSoftBody.h"
#include "bullet_fem/bullet_bridge/vectors.h"
#include "fem/common/message.h"

namespace bullet_fem
{
namespace
{

using Components = NodeSnapshot::Components;
using Node = btSoftBody::Node;

constexpr double kFarthestSaved = 1e6;  // [m] and [m/s]; Bullet's broadphase fails beyond it
constexpr int kLastActivationState = FIXED_BASE_MULTI_BODY;

// Drops the fourth component, which has no meaning here.
Components componentsOf(const btVector3& v)
{
    return {v.x(), v.y(), v.z()};
}

btVector3 vectorOf(const Components& c)
{
    return btVector3(c[0], c[1], c[2]);
}

std::vector<Components> componentsOf(const btSoftBody& soft, btVector3 Node::*member)
{
    std::vector<Components> values(soft.m_nodes.size());
    for (int i = 0; i < soft.m_nodes.size(); ++i) values[i] = componentsOf(soft.m_nodes[i].*member);
    return values;
}

std::vector<Components> componentsOf(const std::vector<btVector3>& vectors)
{
    std::vector<Components> values(vectors.size());
    std::transform(vectors.begin(), vectors.end(), values.begin(), [](const btVector3& v) { return componentsOf(v); });
    return values;
}

std::vector<Components> rounded(const std::vector<Vec3>& vectors)
{
    std::vector<Components> values(vectors.size());
    std::transform(vectors.begin(), vectors.end(), values.begin(),
                   [](const Vec3& v) { return componentsOf(bulletVector(v)); });
    return values;
}

// Compares bits, because 0 == -0.
template <class T>
bool sameBits(const std::vector<T>& a, const std::vector<T>& b)
{
    return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0;
}

template <class T>
bool allZero(const std::vector<T>& values)
{
    return sameBits(values, std::vector<T>(values.size(), T{}));
}

template <class T>
void checkSize(const std::vector<T>& values, int size, const char* name, bool mayBeEmpty = false)
{
    if (values.size() != static_cast<std::size_t>(size) && !(mayBeEmpty && values.empty()))
        reject(values.size(), " ", name, " where the body has ", size);
}

template <class T>
void checkRange(const std::vector<T>& values, const char* name)
{
    for (std::size_t i = 0; i < values.size(); ++i)
        for (int c = 0; c < 3; ++c)
            if (!(std::fabs(values[i][c]) < kFarthestSaved))
                reject("number ", i, " of the ", name, " is not in (-1e6, 1e6)");
}

void checkFlags(const std::vector<unsigned char>& flags, const char* name)
{
    if (std::any_of(flags.begin(), flags.end(), [](unsigned char flag) { return flag > 1; }))
        reject(name, " that are not 0 or 1");
}

void checkPins(const NodeSnapshot& s, int n)
{
    checkSize(s.m_pinVelocity, n, "pin velocities", true);
    checkSize(s.m_pinPosition, n, "pin positions", true);
    checkRange(s.m_pinVelocity, "pin velocities");
    checkRange(s.m_pinPosition, "pin positions");
    checkSize(s.m_hasTarget, n, "target flags", true);
    checkSize(s.m_moved, n, "moved flags", true);
    checkFlags(s.m_hasTarget, "target flags");
    checkFlags(s.m_moved, "moved flags");
    if (!isFinite(s.m_restOrigin)) reject("the rest shape's place is not finite");
}

void checkWritten(const NodeSnapshot& s, int n)
{
    checkSize(s.m_writtenX, n, "written positions", true);
    checkSize(s.m_writtenV, n, "written velocities", true);
    checkRange(s.m_writtenX, "written positions");
    checkRange(s.m_writtenV, "written velocities");
    checkSize(s.m_writtenInverseMass, n, "written inverse masses", true);
    const std::vector<btScalar>& written = s.m_writtenInverseMass.empty() ? s.m_inverseMass : s.m_writtenInverseMass;
    for (std::size_t i = 0; i < written.size(); ++i)
        if (!(written[i] >= 0) || !std::isfinite(written[i]) || (written[i] > 0 && !std::isfinite(1 / written[i])))
            reject("the inverse mass ", written[i], " of node ", i, " is no step's");
}

}  // namespace

NodeSnapshot nodeSnapshotOf(const FemSoftBody& fem)
{
    const btSoftBody& soft = *fem.m_softBody;
    NodeSnapshot s;
    const std::vector<Components> writtenX = componentsOf(fem.m_written.m_x),
                                  writtenV = componentsOf(fem.m_written.m_v);
    s.m_x = componentsOf(soft, &Node::m_x);
    s.m_v = componentsOf(soft, &Node::m_v);
    if (sameBits(s.m_x, writtenX)) s.m_x.clear();
    if (sameBits(s.m_v, writtenV)) s.m_v.clear();
    if (!sameBits(writtenX, rounded(fem.m_body.m_state.m_x))) s.m_writtenX = writtenX;
    if (!sameBits(writtenV, rounded(fem.m_body.m_state.m_v))) s.m_writtenV = writtenV;
    s.m_q = componentsOf(soft, &Node::m_q);
    s.m_vn = componentsOf(soft, &Node::m_vn);
    s.m_f = componentsOf(soft, &Node::m_f);
    if (allZero(s.m_f)) s.m_f.clear();
    s.m_n = componentsOf(soft, &Node::m_n);
    for (int i = 0; i < soft.m_nodes.size(); ++i)
    {
        s.m_inverseMass.push_back(soft.m_nodes[i].m_im);
        s.m_area.push_back(soft.m_nodes[i].m_area);
        s.m_attached.push_back(soft.m_nodes[i].m_battach != 0);
    }
    if (allZero(s.m_attached)) s.m_attached.clear();
    if (!sameBits(fem.m_written.m_inverseMass, s.m_inverseMass)) s.m_writtenInverseMass = fem.m_written.m_inverseMass;
    for (int k = 0; k < soft.m_faces.size(); ++k)
    {
        s.m_faceNormal.push_back(componentsOf(soft.m_faces[k].m_normal));
        s.m_faceArea.push_back(soft.m_faces[k].m_ra);
    }
    s.m_bounds = {componentsOf(soft.m_bounds[0]), componentsOf(soft.m_bounds[1])};
    s.m_constantsOutdated = soft.m_bUpdateRtCst;
    s.m_activation = soft.getActivationState();
    s.m_deactivationTime = soft.getDeactivationTime();
    s.m_maxSpeedSquared = soft.m_maxSpeedSquared;
    if (!allZero(fem.m_pins.m_velocity)) s.m_pinVelocity = fem.m_pins.m_velocity;
    if (!allZero(fem.m_pins.m_position)) s.m_pinPosition = fem.m_pins.m_position;
    if (!allZero(fem.m_pins.m_hasTarget)) s.m_hasTarget = fem.m_pins.m_hasTarget;
    if (!allZero(fem.m_pins.m_moved)) s.m_moved = fem.m_pins.m_moved;
    s.m_restOrigin = fem.m_setUp.m_restOrigin;
    return s;
}

void check(const NodeSnapshot& s, const FemSoftBody& fem)
{
    const int n = fem.m_softBody->m_nodes.size(), faces = fem.m_softBody->m_faces.size();
    // Values that the user wrote to nodes are not checked: the next step repairs them.
    checkSize(s.m_x, n, "node positions", true);
    checkSize(s.m_v, n, "node velocities", true);
    checkSize(s.m_q, n, "last positions");
    checkSize(s.m_vn, n, "last velocities");
    checkSize(s.m_f, n, "forces", true);
    checkSize(s.m_n, n, "normals");
    checkSize(s.m_inverseMass, n, "inverse masses");
    checkSize(s.m_area, n, "node areas");
    checkSize(s.m_attached, n, "anchor flags", true);
    checkFlags(s.m_attached, "anchor flags");
    checkSize(s.m_faceNormal, faces, "face normals");
    checkSize(s.m_faceArea, faces, "face areas");
    checkWritten(s, n);
    checkPins(s, n);
    for (const Components& corner : s.m_bounds)
        for (const btScalar value : corner)
            if (!std::isfinite(value)) reject("the bounds are not finite");
    if (s.m_activation < 0 || s.m_activation > kLastActivationState)
        reject("the activation state is ", s.m_activation, ", not one of Bullet's");
    if (!(s.m_deactivationTime >= 0)) reject("the deactivation time is ", s.m_deactivationTime, " s, below 0");
}

void restore(const NodeSnapshot& s, FemSoftBody& fem)
{
    btSoftBody& soft = *fem.m_softBody;
    const BodyState& state = fem.m_body.m_state;
    for (int i = 0; i < soft.m_nodes.size(); ++i)
    {
        Node& node = soft.m_nodes[i];
        fem.m_written.m_x[i] = s.m_writtenX.empty() ? bulletVector(state.m_x[i]) : vectorOf(s.m_writtenX[i]);
        fem.m_written.m_v[i] = s.m_writtenV.empty() ? bulletVector(state.m_v[i]) : vectorOf(s.m_writtenV[i]);
        fem.m_written.m_inverseMass[i] =
            s.m_writtenInverseMass.empty() ? s.m_inverseMass[i] : s.m_writtenInverseMass[i];
        node.m_x = s.m_x.empty() ? fem.m_written.m_x[i] : vectorOf(s.m_x[i]);
        node.m_v = s.m_v.empty() ? fem.m_written.m_v[i] : vectorOf(s.m_v[i]);
        node.m_q = vectorOf(s.m_q[i]);
        node.m_vn = vectorOf(s.m_vn[i]);
        node.m_f = s.m_f.empty() ? btVector3(0, 0, 0) : vectorOf(s.m_f[i]);
        node.m_n = vectorOf(s.m_n[i]);
        node.m_im = s.m_inverseMass[i];
        node.m_area = s.m_area[i];
        node.m_battach = s.m_attached.empty() || s.m_attached[i] == 0 ? 0 : -1;  // a signed bit
        fem.m_pins.m_velocity[i] = s.m_pinVelocity.empty() ? Vec3() : s.m_pinVelocity[i];
        fem.m_pins.m_position[i] = s.m_pinPosition.empty() ? Vec3() : s.m_pinPosition[i];
        fem.m_pins.m_hasTarget[i] = s.m_hasTarget.empty() ? 0 : s.m_hasTarget[i];
        fem.m_pins.m_moved[i] = s.m_moved.empty() ? 0 : s.m_moved[i];
    }
    for (int k = 0; k < soft.m_faces.size(); ++k)
    {
        soft.m_faces[k].m_normal = vectorOf(s.m_faceNormal[k]);
        soft.m_faces[k].m_ra = s.m_faceArea[k];
    }
    for (int k = 0; k < 2; ++k) soft.m_bounds[k] = vectorOf(s.m_bounds[k]);
    soft.m_bUpdateRtCst = s.m_constantsOutdated;
    soft.forceActivationState(s.m_activation);
    soft.setDeactivationTime(s.m_deactivationTime);
    soft.m_maxSpeedSquared = s.m_maxSpeedSquared;
    fem.m_setUp.m_restOrigin = s.m_restOrigin;
}

}  // namespace bullet_fem

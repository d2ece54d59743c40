// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "plugin/joints/btFemAttachments.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "BulletSoftBody/btSoftBody.h"
#include "bullet_bridge/geometry/limits.h"
#include "bullet_bridge/rigid/rigid_proxies.h"
#include "bullet_fem/btFemVectors.h"

using namespace bullet_fem;

namespace
{

constexpr double kWeightTolerance = 1e-4;  // on the sum of weights [-]

void checkNode(const FemSoftBody& body, int node, const char* caller)
{
    const int count = body.m_softBody->m_nodes.size();
    if (node < 0 || node >= count)
        throw std::invalid_argument(std::string(caller) + ": node " + std::to_string(node) + " is not in [0, " +
                                    std::to_string(count) + ") of its body");
}

void checkWeights(const std::array<double, 4>& weights)
{
    const double sum = weights[0] + weights[1] + weights[2] + weights[3];
    if (!(std::fabs(sum - 1) <= kWeightTolerance))
        throw std::invalid_argument("attach: the weights have the sum " + std::to_string(sum) + ", not 1");
}

void checkGroup(const FemSoftBody& body, const btFemNodeGroup& group, const char* caller)
{
    if (group.m_count < 0 || (group.m_count > 0 && !group.m_nodes))
        throw std::invalid_argument(std::string(caller) + ": a group of " + std::to_string(group.m_count) +
                                    " nodes; give an array and its length");
    for (int k = 0; k < group.m_count; ++k) checkNode(body, group.m_nodes[k], caller);
}

void setTarget(FemSoftBody& body, int node, const Vec3& position)
{
    body.m_pins.m_position[node] = position;
    body.m_pins.m_hasTarget[node] = 1;
}

btFemHold holdOf(HeldJoint::Kind kind)
{
    switch (kind)
    {
        case HeldJoint::Kind::anchor:
            return btFemHold::anchor;
        case HeldJoint::Kind::deformableAnchor:
            return btFemHold::deformableAnchor;
        case HeldJoint::Kind::attachment:
            return btFemHold::attachment;
        case HeldJoint::Kind::linearJoint:
            return btFemHold::linearJoint;
        case HeldJoint::Kind::spring:
            return btFemHold::spring;
        case HeldJoint::Kind::angularJoint:
            break;
    }
    return btFemHold::angularJoint;
}

void checkTarget(int node, const Vec3& position)
{
    if (isBelow(kFarthest, position)) return;
    throw std::invalid_argument("setNodeTargets: the position of node " + std::to_string(node) + " is (" +
                                std::to_string(position.x) + ", " + std::to_string(position.y) + ", " +
                                std::to_string(position.z) +
                                "), not finite or not in [-1e6, 1e6] m; give a place near the body");
}

}  // namespace

int attachCloth(FemSoftBody& body, const std::array<int, 4>& nodes, const std::array<double, 4>& weights,
                btSoftBody& cloth, int clothNode)
{
    if (clothNode < 0 || clothNode >= cloth.m_nodes.size())
        throw std::invalid_argument("attach: node " + std::to_string(clothNode) + " is not in [0, " +
                                    std::to_string(cloth.m_nodes.size()) + ") of the cloth");
    for (int node : nodes) checkNode(body, node, "attach");
    checkWeights(weights);
    ClothAttachment attachment;
    attachment.m_id = ++body.m_joints.m_lastId;
    attachment.m_cloth = &cloth;
    attachment.m_clothId = broadphaseId(cloth);
    attachment.m_clothNode = clothNode;
    attachment.m_nodes = nodes;
    attachment.m_weights = weights;
    body.m_joints.m_clothAttachments.push_back(attachment);
    body.m_softBody->activate();
    return attachment.m_id;
}

int attachNode(FemSoftBody& body, int node, const FemSoftBody& other, const std::array<int, 4>& otherNodes,
               const std::array<double, 4>& weights)
{
    checkNode(body, node, "attach");
    for (int a = 0; a < 4; ++a)
    {
        checkNode(other, otherNodes[a], "attach");
        if (&body == &other && otherNodes[a] == node && weights[a] != 0)
            throw std::invalid_argument("attach: node " + std::to_string(node) + " would be tied to itself");
    }
    checkWeights(weights);
    NodeAttachment attachment;
    attachment.m_id = ++body.m_joints.m_lastId;
    attachment.m_node = node;
    attachment.m_other = other.m_softBody;
    attachment.m_otherMark = other.m_setUp.m_mark;
    attachment.m_otherNodes = otherNodes;
    attachment.m_weights = weights;
    body.m_joints.m_attachments.push_back(attachment);
    body.m_memory.m_place.forget();  // attached nodes have no contact
    return attachment.m_id;
}

void detachNode(FemSoftBody& body, int attachment)
{
    std::vector<NodeAttachment>& all = body.m_joints.m_attachments;
    all.erase(std::remove_if(all.begin(), all.end(), [&](const NodeAttachment& a) { return a.m_id == attachment; }),
              all.end());
    std::vector<Weld>& welds = body.m_joints.m_welds;
    welds.erase(std::remove_if(welds.begin(), welds.end(), [&](const Weld& w) { return w.m_id == attachment; }),
                welds.end());
    std::vector<ClothAttachment>& cloth = body.m_joints.m_clothAttachments;
    cloth.erase(
        std::remove_if(cloth.begin(), cloth.end(), [&](const ClothAttachment& a) { return a.m_id == attachment; }),
        cloth.end());
    body.m_memory.m_place.forget();  // detached nodes have contact again
}

void setTargets(FemSoftBody& body, const btFemNodeGroup& group, const btVector3* positions)
{
    checkGroup(body, group, "setNodeTargets");
    if (group.m_count > 0 && !positions) throw std::invalid_argument("setNodeTargets: the positions are null");
    for (int k = 0; k < group.m_count; ++k) checkTarget(group.m_nodes[k], vec3(positions[k]));
    for (int k = 0; k < group.m_count; ++k) setTarget(body, group.m_nodes[k], vec3(positions[k]));
}

void setTargets(FemSoftBody& body, const btFemNodeGroup& group, const btTransform& fromRest)
{
    checkGroup(body, group, "setNodeTargets");
    const std::vector<Vec3>& X = body.m_body.m_model->mesh().restPositions();
    const auto moved = [&](int node) { return vec3(fromRest * bulletVector(body.m_setUp.m_restOrigin + X[node])); };
    for (int k = 0; k < group.m_count; ++k) checkTarget(group.m_nodes[k], moved(group.m_nodes[k]));
    for (int k = 0; k < group.m_count; ++k) setTarget(body, group.m_nodes[k], moved(group.m_nodes[k]));
}

void clearTargets(FemSoftBody& body, const btFemNodeGroup& group)
{
    checkGroup(body, group, "clearNodeTargets");
    for (int k = 0; k < group.m_count; ++k) body.m_pins.m_hasTarget[group.m_nodes[k]] = 0;
}

int addSpring(FemSoftBody& body, const btFemSpring& spring)
{
    std::string why;
    if (!spring.valid(&why)) throw std::invalid_argument("addSpring: " + why);
    NodeSpring added;
    for (int a = 0; a < 3; ++a)
    {
        if (spring.m_weights[a] == 0) continue;
        checkNode(body, spring.m_nodes[a], "addSpring");
        added.m_nodes[a] = spring.m_nodes[a];
    }
    for (int a = 0; a < 3; ++a) added.m_weights[a] = spring.m_weights[a];
    added.m_target = vec3(spring.m_target);
    added.m_stiffness = spring.m_stiffness;
    added.m_damping = spring.m_damping;
    added.m_maxForce = spring.m_maxForce;
    added.m_id = ++body.m_joints.m_lastId;
    body.m_joints.m_springs.push_back(added);
    return added.m_id;
}

void setSpringTarget(FemSoftBody& body, int spring, const btVector3& target)
{
    btFemSpring moved;
    moved.m_target = target;
    std::string why;
    if (!moved.valid(&why)) throw std::invalid_argument("setSpringTarget: " + why);
    for (NodeSpring& known : body.m_joints.m_springs)
    {
        if (known.m_id != spring) continue;
        known.m_target = vec3(target);
        return;
    }
    throw std::invalid_argument("setSpringTarget: the body has no spring " + std::to_string(spring) +
                                "; give what addSpring returned for it");
}

void removeSpring(FemSoftBody& body, int spring)
{
    std::vector<NodeSpring>& all = body.m_joints.m_springs;
    all.erase(std::remove_if(all.begin(), all.end(), [&](const NodeSpring& s) { return s.m_id == spring; }), all.end());
}

void writeReports(const FemSoftBody& body, btAlignedObjectArray<btFemAnchorReport>& reports)
{
    reports.resize(0);
    for (const HeldJoint& held : body.m_joints.m_now)
    {
        btFemAnchorReport report;
        report.m_kind = holdOf(held.m_kind);
        report.m_node = held.m_node;
        report.m_attachment = held.m_id;
        report.m_joint = held.m_source;
        report.m_object = held.m_object;
        report.m_point = bulletVector(held.m_point);
        report.m_impulse = bulletVector(held.m_impulse);
        report.m_error = static_cast<btScalar>(held.m_error);
        reports.push_back(report);
    }
}

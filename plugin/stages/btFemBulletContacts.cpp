// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "plugin/stages/btFemBulletContacts.h"

#include <algorithm>
#include <array>
#include <new>
#include <utility>

#include "BulletSoftBody/btSoftBody.h"
#include "bullet_bridge/body/rigid_dispatch.h"
#include "bullet_bridge/rigid/world_objects.h"
#include "plugin/record/btFemBodyRecord.h"
#include "plugin/record/btFemTouches.h"

using namespace bullet_fem;

namespace
{

using FaceContact = btSoftBody::DeformableFaceRigidContact;

Triangle ascending(Triangle nodes)
{
    std::sort(nodes.begin(), nodes.end());
    return nodes;
}

Triangle nodesOf(const btSoftBody::Face& face, const btSoftBody& soft)
{
    Triangle nodes;
    for (int a = 0; a < 3; ++a) nodes[a] = static_cast<int>(face.m_n[a] - &soft.m_nodes[0]);
    return nodes;
}

void refresh(btFemFaceIndex& index, const btSoftBody& soft, const TetMesh& mesh)
{
    const void* first = soft.m_faces.size() > 0 ? &soft.m_faces[0] : nullptr;
    if (index.m_first == first && index.m_count == soft.m_faces.size()) return;
    std::vector<std::pair<Triangle, int>> faces;
    for (int f = 0; f < soft.m_faces.size(); ++f) faces.push_back({ascending(nodesOf(soft.m_faces[f], soft)), f});
    std::sort(faces.begin(), faces.end());
    index.m_faceOf.clear();
    for (const Triangle& triangle : mesh.surface())
    {
        const Triangle key = ascending(triangle);
        const auto found = std::lower_bound(faces.begin(), faces.end(), std::make_pair(key, 0));
        index.m_faceOf.push_back(found != faces.end() && found->first == key ? found->second : -1);
    }
    index.m_first = first;
    index.m_count = soft.m_faces.size();
}

// The node of largest weight.
int nearestNode(const btFemContact& contact)
{
    const btScalar* const weights = contact.m_weights;
    return contact.m_nodes[std::max_element(weights, weights + contact.m_nodeCount) - weights];
}

// A face that contains the contact point, with the weights in the order of its nodes; null if there is none.
btSoftBody::Face* faceAt(const btFemContact& contact, const btFemBodyRecord& record, btVector3& weights)
{
    if (record.fem().m_skin) return nullptr;  // faces of the mesh do not contain a skin's points
    btSoftBody& soft = *record.m_softBody;
    for (int t : record.fem().m_surface.topology().trianglesAt(nearestNode(contact)))
    {
        const int index = record.m_model.m_faceIndex.m_faceOf[t];
        if (index < 0) continue;
        const Triangle nodes = nodesOf(soft.m_faces[index], soft);
        weights.setZero();
        btScalar sum = 0;
        for (int a = 0; a < 3; ++a)
            for (int b = 0; b < contact.m_nodeCount; ++b)
                if (contact.m_weights[b] != 0 && contact.m_nodes[b] == nodes[a])
                    weights[a] += contact.m_weights[b], sum += contact.m_weights[b];
        if (sum > btScalar(0.999)) return &soft.m_faces[index];
    }
    return nullptr;
}

// Bullet from 3.26 on keeps the impulse on the rigid object [N s], of which pybullet makes contact forces.
template <class Info>
auto setImpulse(Info& info, const btVector3& impulse, int) -> decltype(info.m_impulse, void())
{
    info.m_impulse = impulse;
}

template <class Info>
void setImpulse(Info&, const btVector3&, long)
{
}

// Sets two unit tangents, the first along the friction on the soft body if that is more than rounding of the impulse.
void setTangents(btVector3& t1, btVector3& t2, const btFemContact& contact)
{
    btPlaneSpace1(contact.m_normal, t1, t2);
    const btVector3& friction = contact.m_frictionImpulse;
    if (friction.length2() <= SIMD_EPSILON * contact.m_impulse.length2()) return;
    t1 = friction.normalized();
    t2 = contact.m_normal.cross(t1);
}

// Fills the members that both kinds of contact have. A zero impulse matrix and inverse mass keep solvers from acting on
// them.
template <class Contact>
void fill(Contact& to, const btFemContact& contact)
{
    const btVector3 zero(0, 0, 0);
    to.m_cti.m_colObj = contact.m_other;
    to.m_cti.m_normal = contact.m_normal;
    to.m_cti.m_offset = contact.m_gap - contact.m_normal.dot(contact.m_point);
    to.m_cti.m_bary = zero;
    setImpulse(to.m_cti, -contact.m_impulse, 0);
    to.m_c0.setValue(0, 0, 0, 0, 0, 0, 0, 0, 0);
    to.m_c1 = contact.m_point - contact.m_other->getWorldTransform().getOrigin();
    to.m_c2 = to.m_c3 = to.m_c4 = 0;
    setTangents(to.t1, to.t2, contact);
}

// Appends in place, as copies of a contact would copy its multibody data.
template <class Contact>
Contact& append(btAlignedObjectArray<Contact>& contacts)
{
    return *new (&contacts.expandNonInitializing()) Contact();
}

}  // namespace

void makeRoomForBulletContacts(const btFemBodyRecord& record)
{
    if (record.fem().m_memory.m_contacts.empty()) return;
    record.m_softBody->m_rcontacts.reserve(record.m_reports.m_contacts.capacity());
    record.m_softBody->m_faceRigidContacts.reserve(record.m_reports.m_contacts.capacity());
}

void writeBulletContacts(btFemBodyRecord& record, WorldObjects& world)
{
    btSoftBody& soft = *record.m_softBody;
    clearBulletContacts(soft);
    const int rigid =
        std::min(static_cast<int>(record.fem().m_memory.m_contacts.size()), record.m_reports.m_contacts.size());
    if (rigid == 0) return;
    refresh(record.m_model.m_faceIndex, soft, record.fem().m_body.m_model->mesh());
    for (int k = 0; k < rigid; ++k)  // contacts with soft bodies follow
    {
        const btFemContact& contact = record.m_reports.m_contacts[k];
        if (!isTouch(contact, 0) || !world.readAndHolds(soft, contact.m_other)) continue;
        btSoftBody::RContact& atNode = append(soft.m_rcontacts);
        fill(atNode, contact);
        atNode.m_node = &soft.m_nodes[nearestNode(contact)];
        btVector3 weights;
        btSoftBody::Face* face = faceAt(contact, record, weights);
        if (!face) continue;
        FaceContact& atFace = append(soft.m_faceRigidContacts);
        fill(atFace, contact);
        atFace.m_c5.setValue(0, 0, 0, 0, 0, 0, 0, 0, 0);
        atFace.m_cti.m_bary = atFace.m_bary = atFace.m_weights = weights;
        atFace.m_contactPoint = contact.m_point;
        atFace.m_face = face;
    }
}

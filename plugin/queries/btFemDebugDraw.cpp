// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "bullet_fem/btFemDebugDraw.h"

#include <stdexcept>
#include <vector>

#include "BulletSoftBody/btSoftBody.h"
#include "LinearMath/btIDebugDraw.h"
#include "bullet_fem/btFemSoftBodySolver.h"
#include "bullet_fem/btFemVectors.h"
#include "fem/common/attempt.h"
#include "plugin/record/btFemBodyRecord.h"
#include "plugin/record/btFemCoupling.h"
#include "plugin/record/btFemRangeCheck.h"
#include "plugin/record/btFemRigidFit.h"

using namespace bullet_fem;

namespace
{

constexpr btScalar kHead = btScalar(0.2);  // head of an arrow, as a share of its length

void drawElements(const btSoftBody& soft, btIDebugDraw& drawer, const btFemDrawSettings& settings)
{
    for (int e = 0; e < soft.m_tetras.size(); ++e)
    {
        btVector3 x[4], middle(0, 0, 0);
        for (int a = 0; a < 4; ++a) middle += btScalar(0.25) * (x[a] = soft.m_tetras[e].m_n[a]->m_x);
        for (btVector3& corner : x) corner = middle + settings.m_shrink * (corner - middle);
        for (int a = 0; a < 4; ++a)
            for (int b = 0; b < a; ++b) drawer.drawLine(x[a], x[b], settings.m_elementColor);
    }
}

void drawStressFree(const FemSoftBody& fem, btIDebugDraw& drawer, const btFemDrawSettings& settings)
{
    const btFemRigidFit fit(fem);
    for (const Triangle& t : fem.m_body.m_model->mesh().surface())
        for (int k = 0; k < 3; ++k)
            if (t[k] < t[(k + 1) % 3])  // every edge once: the adjacent triangle has it in the opposite direction
                drawer.drawLine(fit.place(t[k]), fit.place(t[(k + 1) % 3]), settings.m_restColor);
}

void drawArrow(const btVector3& from, const btVector3& way, btIDebugDraw& drawer, const btVector3& color)
{
    const btVector3 tip = from + way;
    drawer.drawLine(from, tip, color);
    btVector3 aside, other;
    btPlaneSpace1(way.normalized(), aside, other);
    aside *= kHead / 2 * way.length();
    drawer.drawLine(tip, tip - kHead * way + aside, color);
    drawer.drawLine(tip, tip - kHead * way - aside, color);
}

void drawContact(const btFemContact& contact, btIDebugDraw& drawer, const btFemDrawSettings& settings)
{
    for (int c = 0; c < 3; ++c)
    {
        btVector3 arm(0, 0, 0);
        arm[c] = settings.m_pointSize;
        drawer.drawLine(contact.m_point - arm, contact.m_point + arm, settings.m_pointColor);
    }
    if (settings.m_normalLength > 0)
        drawer.drawLine(contact.m_point, contact.m_point + settings.m_normalLength * contact.m_normal,
                        settings.m_normalColor);
    const btVector3 arrow = settings.m_impulseScale * contact.m_impulse;
    if (arrow.length2() > SIMD_EPSILON * SIMD_EPSILON)
        drawArrow(contact.m_point, arrow, drawer, settings.m_impulseColor);
}

}  // namespace

bool btFemDrawSettings::valid(std::string* why) const
{
    const auto isLength = [](btScalar value) { return value >= 0 && value <= btScalar(1e6); };
    return btFemRangeCheck(m_shrink > 0 && m_shrink <= 1, why, "m_shrink", m_shrink, "(0, 1]; 0.9 is usual") &&
           btFemRangeCheck(isLength(m_pointSize), why, "m_pointSize", m_pointSize, "[0, 1e6] m; 0.02 is usual") &&
           btFemRangeCheck(isLength(m_normalLength), why, "m_normalLength", m_normalLength,
                           "[0, 1e6] m; 0.1 is usual") &&
           btFemRangeCheck(isLength(m_impulseScale), why, "m_impulseScale", m_impulseScale,
                           "[0, 1e6] m per N s; 0.1 is usual");
}

bool btFemDebugDraw::draw(const btFemSoftBodySolver& fem, const btSoftBody* body, btIDebugDraw* drawer, int modes,
                          const btFemDrawSettings& settings, std::string* why)
{
    const auto check = [&settings]
    {
        std::string reason;
        if (!settings.valid(&reason)) throw std::invalid_argument("btFemDrawSettings: " + reason);
    };
    if (!attempt(why, check)) return false;
    if (!drawer || !fem.isFem(body)) return true;
    const btFemBodyRecord& record = *btFemCoupling::record(fem, *body);
    if (modes & BT_FEM_DRAW_ELEMENTS) drawElements(*body, *drawer, settings);
    if (modes & BT_FEM_DRAW_STRESS_FREE) drawStressFree(record.fem(), *drawer, settings);
    for (int k = 0; (modes & BT_FEM_DRAW_CONTACTS) && k < record.m_reports.m_contacts.size(); ++k)
        drawContact(record.m_reports.m_contacts[k], *drawer, settings);
    return true;
}

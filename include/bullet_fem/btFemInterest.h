// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <functional>
#include <string>

#include "LinearMath/btVector3.h"
#include "bullet_fem/btFemPrecision.h"
#include "bullet_fem/fem/common/export.h"

class btSoftBody;

/// Tells how much bodies matter, so that those that do not cost less: see btFemSoftBodySolver::setInterest.
class btFemInterest
{
public:
    virtual ~btFemInterest() = default;

    /// Interest in a body [-], in [0, 1]: 0 for what nobody looks at. Other values are clamped and NaN counts as 1,
    /// both flagged BT_FEM_BAD_INTEREST. Asked once a step for every awake FEM body whose detail is automatic, by the
    /// thread that steps the world, when the body's nodes and getAabb() are those of the step that begins. Must not
    /// throw, nor change bodies, world or solver.
    virtual btScalar interest(const btSoftBody& body) = 0;
};

/// From interest to detail: nodalWarp, oneIteration or direct. A body rises as soon as its interest reaches a level. It
/// sinks when its interest is below the level's lower bound and it has been there for m_dwell: once in that time at
/// most, whatever its interest does. On every level no step leaves a residual above 5 %, whatever iterations that takes
/// of bodies that bend far or whose factor is stale: details do not show when they change.
struct BULLETFEM_API btFemDetailPolicy
{
    btScalar m_fullFrom = btScalar(0.5);      ///< interest from which on a body is iterated to the tolerance [-]
    btScalar m_fullUntil = btScalar(0.4);     ///< below it a residual of 5 % is enough [-], in [0, m_fullFrom]
    btScalar m_reducedFrom = btScalar(0.2);   ///< interest from which on it is worth one rotation a node [-]
    btScalar m_reducedUntil = btScalar(0.1);  ///< below it direct mode is enough [-], in [0, m_reducedFrom]
    btScalar m_dwell = btScalar(0.5);         ///< simulated time in a level before a body sinks [s], in [0, 3600]

    /// True if all bounds are in [0, 1] and in order (both of "reduced" at most those of "full") and the dwell is in
    /// range; else `why` (if given) names the value, the range and the remedy.
    bool valid(std::string* why = nullptr) const;
};

/// Interest by distance from a viewer to the box around a body: 1 up to the near distance, 0 from the far one on,
/// linear between them; 0 for what is not visible.
class BULLETFEM_API btFemViewerInterest : public btFemInterest
{
public:
    /// Distances [m], finite, 0 <= near < far. Throws std::invalid_argument otherwise.
    btFemViewerInterest(btScalar nearDistance, btScalar farDistance);

    /// True if the constructor takes them; else `why` (if given) has its message. For engines without exceptions.
    static bool valid(btScalar nearDistance, btScalar farDistance, std::string* why = nullptr);

    /// Where the viewer is, world [m]; the origin unless called. One that is not finite makes the interest NaN.
    void setViewer(const btVector3& position) { m_viewer = position; }

    /// Says whether a body can be seen, e.g. from the renderer's culling; all can unless it is given. An empty function
    /// takes it back. The rules of btFemInterest::interest hold for it.
    void setVisibility(std::function<bool(const btSoftBody&)> isVisible) { m_isVisible = std::move(isVisible); }

    btScalar interest(const btSoftBody& body) override;

private:
    btScalar m_near, m_far;
    btVector3 m_viewer{0, 0, 0};
    std::function<bool(const btSoftBody&)> m_isVisible;
};

// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <functional>
#include <string>

#include "LinearMath/btVector3.h"
#include "bullet_fem/btFemPrecision.h"
#include "bullet_fem/fem/common/export.h"

class btSoftBody;

/// Interface that rates the importance of bodies, so that unimportant ones cost less: see
/// btFemSoftBodySolver::setInterest.
class btFemInterest
{
public:
    virtual ~btFemInterest() = default;

    /// Interest in a body [-], in [0, 1]; 0 for an unobserved body. Other values are clamped and NaN counts as 1, both
    /// flagged BT_FEM_BAD_INTEREST. Called once a step for every awake FEM body whose detail is automatic, by the
    /// thread that steps the world, when the body's nodes and getAabb() are those at the beginning of the step. Must
    /// not throw, nor change bodies, world or solver.
    virtual btScalar interest(const btSoftBody& body) = 0;
};

/// Mapping from interest to detail: nodalWarp, oneIteration or direct. A body rises to a level as soon as its interest
/// reaches the level's threshold. It sinks when its interest is below the level's lower threshold and it has had the
/// level for m_dwell, so at most once in that time. On every level the residual of a step is at most 5 %, with as many
/// iterations as strongly bent bodies or stale factors need, so that changes of detail are not visible.
struct BULLETFEM_API btFemDetailPolicy
{
    btScalar m_fullFrom = btScalar(0.5);   ///< interest at which a body gets the full tolerance [-]
    btScalar m_fullUntil = btScalar(0.4);  ///< interest below which a residual of 5 % suffices [-], in [0, m_fullFrom]
    btScalar m_reducedFrom = btScalar(0.2);   ///< interest at which a body gets one rotation per node [-]
    btScalar m_reducedUntil = btScalar(0.1);  ///< interest below which direct mode suffices [-], in [0, m_reducedFrom]
    btScalar m_dwell = btScalar(0.5);         ///< simulated time on a level before a body sinks [s], in [0, 3600]

    /// True if all bounds are in [0, 1] and in order (both of "reduced" at most those of "full") and the dwell is in
    /// range; else `why` (if given) names the value, the range and the remedy.
    bool valid(std::string* why = nullptr) const;
};

/// Interest by distance from a viewer to the body's bounding box: 1 up to the near distance, 0 beyond the far one,
/// linear in between; 0 for an invisible body.
class BULLETFEM_API btFemViewerInterest : public btFemInterest
{
public:
    /// Distances [m], finite, 0 <= near < far. Throws std::invalid_argument otherwise.
    btFemViewerInterest(btScalar nearDistance, btScalar farDistance);

    /// True if the constructor takes them; else `why` (if given) has its message. For engines without exceptions.
    static bool valid(btScalar nearDistance, btScalar farDistance, std::string* why = nullptr);

    /// Sets the viewer's position in the world [m]; initially the origin. A position that is not finite makes the
    /// interest NaN.
    void setViewer(const btVector3& position) { m_viewer = position; }

    /// Sets a function that tells whether a body is visible, e.g. from the renderer's culling; without it all bodies
    /// are. An empty function removes it. It must obey the rules of btFemInterest::interest.
    void setVisibility(std::function<bool(const btSoftBody&)> isVisible) { m_isVisible = std::move(isVisible); }

    btScalar interest(const btSoftBody& body) override;

private:
    btScalar m_near, m_far;
    btVector3 m_viewer{0, 0, 0};
    std::function<bool(const btSoftBody&)> m_isVisible;
};

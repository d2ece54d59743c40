// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "LinearMath/btAlignedObjectArray.h"
#include "bullet_bridge/body/fem_soft_body.h"
#include "bullet_fem/btFemAnchors.h"
#include "bullet_fem/btFemFracture.h"
#include "bullet_fem/btFemReports.h"
#include "bullet_fem/fem/fracture/fracture.h"
#include "plugin/record/btFemDetailLevel.h"
#include "plugin/record/btFemFactorAccount.h"
#include "plugin/record/btFemInsideOut.h"
#include "plugin/record/btFemRealTime.h"
#include "plugin/record/btFemSleepRecord.h"
#include "plugin/record/btFemSources.h"
#include "plugin/record/btFemTooSoft.h"

struct btFemFactorJob;

/// How far a body has come in a step.
enum class btFemStage
{
    none,       ///< between steps
    predicted,  ///< in predictMotion
    free,       ///< its free motion is solved; contact is not
    solved      ///< contact is solved too, within the rigid solver
};

/// Who moves a body.
enum class btFemMover
{
    undecided,  ///< its set-up was not tried yet
    fem,        ///< finite elements
    springs     ///< Bullet's springs: it cannot be FEM, see btFemSetUpResult::m_message
};

/// The world that steps a body.
struct btFemMembership
{
    const void* m_world = nullptr;        ///< its array of soft bodies; null while the body is not in a world
    const void* m_formerWorld = nullptr;  ///< the one it was taken over from
    int m_handedBack = 0;                 ///< times that the former world claimed it again
    bool m_present = false;               ///< the world being stepped holds it, and shall step it
};

/// What the user asked for.
struct btFemRequest
{
    bullet_fem::ElementMaterials m_materials;
    bool m_materialGiven = false;
    bool m_materialChanged = false;  ///< the model does not have it yet
    btFemDetail m_detail = btFemDetail::automatic;
    double m_contactOffset = 0;                           ///< [m]
    std::shared_ptr<const btFemDefinition> m_definition;  ///< rest shape and masses, until it is set up
    std::shared_ptr<const btFemBaked> m_baked;            ///< rest shape and factor, likewise
    btFemTensileStrength m_strength;                      ///< no tension: it does not split
};

/// Which of m_faces the triangles of a body's surface are.
struct btFemFaceIndex
{
    std::vector<int> m_faceOf;      ///< per surface triangle; -1: none of them
    const void* m_first = nullptr;  ///< where m_faces was when this was made
    int m_count = -1;               ///< and how many they were
};

/// Where a body splits.
struct btFemCracks
{
    explicit btFemCracks(std::shared_ptr<const bullet_fem::RestShape> shape) : m_fracture(std::move(shape)) {}

    bullet_fem::Fracture m_fracture;
    bullet_fem::SplitMesh m_split;  ///< if it is found
    bool m_found = false;           ///< in this step
};

/// What became of it.
struct btFemSetUpResult
{
    std::unique_ptr<bullet_fem::FemSoftBody> m_fem;
    std::shared_ptr<const bullet_fem::BodyModel> m_formerModel;       ///< kept, so that a step size that comes and goes
    std::shared_ptr<bullet_fem::ComplianceCache> m_formerCompliance;  ///< is not factored for again and again
    bool m_rejected = false;
    bool m_asksSkin = false, m_hasAskedSurface = false;  ///< what was wanted to collide when that was last looked at
    std::string m_message;
    bool m_wasChanged = false;  ///< by the program, which appended, removed or rejoined nodes or tetrahedra
    int m_flags = 0;            ///< that hold until the body is set up anew
    btFemTooSoft m_tooSoft;
    btFemFaceIndex m_faceIndex;
    std::unique_ptr<btFemCracks> m_cracks;  ///< of a body that has a strength, once a step has ended
};

/// What steps work with, and carry on to the next.
struct btFemStepWork
{
    btFemStage m_stage = btFemStage::none;
    double m_lastStep = 0;        ///< [s]
    bool m_isFinished = false;    ///< its nodes have normals and a speed: see btFemWorldStep::finish
    double m_factorMismatch = 1;  ///< factorMismatch() as the step began
    double m_staleness = 1;       ///< staleness() in the free motion
    btFemSleepRecord m_sleep;
    btFemDetailLevel m_detailLevel;
    btFemFactorAccount m_factorAccount;
    std::shared_ptr<btFemFactorJob> m_factorJob;  ///< the next factor, being made in the background
    btFemRealTime m_realTime;
    btFemInsideOut m_insideOut;
};

/// What the user reads.
struct btFemBodyReports
{
    btFemStepReport m_step;
    btAlignedObjectArray<btFemContact> m_contacts;
    btAlignedObjectArray<btFemTouch> m_touches;
    btAlignedObjectArray<btFemAnchorReport> m_anchors;
};

/// All that the solver knows of one btSoftBody.
struct btFemBodyRecord
{
    explicit btFemBodyRecord(btSoftBody* softBody) : m_softBody(softBody) {}

    btSoftBody* m_softBody;
    btFemMembership m_membership;
    btFemRequest m_asked;
    btFemSetUpResult m_model;
    btFemStepWork m_work;
    btFemBodyReports m_reports;

    btFemMover mover() const
    {
        if (m_model.m_fem) return btFemMover::fem;
        return m_model.m_rejected ? btFemMover::springs : btFemMover::undecided;
    }
    bool isFem() const { return m_model.m_fem != nullptr; }
    bool isStepped() const { return m_membership.m_present && isFem(); }
    /// Of a body that is FEM.
    bullet_fem::FemSoftBody& fem() const { return *m_model.m_fem; }
};

/// Of a solver, in the order in which they became known.
using btFemRecords = std::vector<std::unique_ptr<btFemBodyRecord>>;

/// What a body is made of: what the user said, or what Bullet's fields say.
bullet_fem::ElementMaterials materialsOf(const btFemBodyRecord& record);

/// The detail that a body's next free motion is solved with: what touches something is iterated to the tolerance.
btFemDetail detailInUse(const btFemBodyRecord& record);

/// Those of BT_FEM_PENETRATING and BT_FEM_INSIDE_OUT that a FEM body's last step left it with.
int stateFlags(const btFemBodyRecord& record);

/// By how much a body's factor is off for a step [s]: 1 if it is fresh, the largest ratio of step or masses if it is
/// not, infinity if other nodes are fixed than those that it was made for.
double staleness(const btFemBodyRecord& record, double step);

/// A body's own step [s]: Bullet scales time by m_cfg.timescale.
double bodyStep(const btFemBodyRecord& record, double worldStep);

/// Takes over what the user wrote to the nodes of a FEM body; what could not be used is flagged in its report.
void readBody(btFemBodyRecord& record);

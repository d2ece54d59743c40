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

/// Stage of a body within a step.
enum class btFemStage
{
    none,       ///< between steps
    predicted,  ///< in predictMotion
    free,       ///< free motion is solved, contact is not
    solved      ///< contact is also solved, within the rigid solver
};

/// Solver that moves a body.
enum class btFemMover
{
    undecided,  ///< set-up was not tried yet
    fem,        ///< finite elements
    springs     ///< Bullet's springs, because set-up failed: see btFemSetUpResult::m_message
};

/// The world that steps a body.
struct btFemMembership
{
    const void* m_world = nullptr;        ///< the world's array of soft bodies; null while the body is in no world
    const void* m_formerWorld = nullptr;  ///< the world from which it was taken over
    int m_handedBack = 0;                 ///< number of times that the former world claimed it again
    bool m_present = false;               ///< the world being stepped contains it and steps it
    int m_fittedLeaf = -1;                ///< broadphase id whose leaf was fitted to the body's bounds; -1: none
};

/// Settings by the user.
struct btFemRequest
{
    bullet_fem::ElementMaterials m_materials;
    bool m_materialGiven = false;
    bool m_materialChanged = false;  ///< the model does not include it yet
    btFemDetail m_detail = btFemDetail::automatic;
    double m_contactOffset = 0;                           ///< [m]
    std::shared_ptr<const btFemDefinition> m_definition;  ///< rest shape and masses, until set-up
    std::shared_ptr<const btFemBaked> m_baked;            ///< rest shape and factor, until set-up
    btFemTensileStrength m_strength;                      ///< tension 0: the body never splits
};

/// Map from the triangles of a body's surface to m_faces.
struct btFemFaceIndex
{
    std::vector<int> m_faceOf;      ///< face of each surface triangle; -1: none
    const void* m_first = nullptr;  ///< address of m_faces at that time
    int m_count = -1;               ///< number of faces at that time
};

/// Crack search of a body.
struct btFemCracks
{
    explicit btFemCracks(std::shared_ptr<const bullet_fem::RestShape> shape) : m_fracture(std::move(shape)) {}

    bullet_fem::Fracture m_fracture;
    bullet_fem::SplitMesh m_split;  ///< result, if m_found
    bool m_found = false;           ///< a crack was found in this step
};

/// Results of set-up.
struct btFemSetUpResult
{
    std::unique_ptr<bullet_fem::FemSoftBody> m_fem;
    std::shared_ptr<const bullet_fem::BodyModel> m_formerModel;       ///< kept, so that alternating step sizes
    std::shared_ptr<bullet_fem::ComplianceCache> m_formerCompliance;  ///< do not cause repeated factorizations
    bool m_rejected = false;
    bool m_asksSkin = false, m_hasAskedSurface = false;  ///< requested collision surface at the last check
    std::string m_message;
    bool m_wasChanged = false;  ///< the program appended, removed or reconnected nodes or tetrahedra
    int m_flags = 0;            ///< flags that persist until the body is set up anew
    btFemTooSoft m_tooSoft;
    btFemFaceIndex m_faceIndex;
    std::unique_ptr<btFemCracks> m_cracks;  ///< of a body with a strength, after its first step
};

/// State that steps use and pass on to the next step.
struct btFemStepWork
{
    btFemStage m_stage = btFemStage::none;
    double m_lastStep = 0;        ///< [s]
    bool m_isFinished = false;    ///< normals and speed are updated: see btFemWorldStep::publish
    double m_factorMismatch = 1;  ///< factorMismatch() at the beginning of the step
    double m_staleness = 1;       ///< staleness() in the free motion
    btFemSleepRecord m_sleep;
    btFemDetailLevel m_detailLevel;
    btFemFactorAccount m_factorAccount;
    std::shared_ptr<btFemFactorJob> m_factorJob;  ///< the next factor, computed in the background
    btFemRealTime m_realTime;
    btFemInsideOut m_insideOut;
};

/// Reports to the user.
struct btFemBodyReports
{
    btFemStepReport m_step;
    btAlignedObjectArray<btFemContact> m_contacts;
    btAlignedObjectArray<btFemTouch> m_touches;
    btAlignedObjectArray<btFemAnchorReport> m_anchors;
};

/// The solver's record of one btSoftBody.
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
    /// The FEM body; requires isFem().
    bullet_fem::FemSoftBody& fem() const { return *m_model.m_fem; }
};

/// The records of a solver, in the order of creation.
using btFemRecords = std::vector<std::unique_ptr<btFemBodyRecord>>;

/// Materials of a body: those set by the user, or else from Bullet's fields.
bullet_fem::ElementMaterials materialsOf(const btFemBodyRecord& record);

/// The detail of a body's next free motion; bodies in contact are iterated to the tolerance.
btFemDetail detailInUse(const btFemBodyRecord& record);

/// The flags BT_FEM_PENETRATING and BT_FEM_INSIDE_OUT after a FEM body's last step.
int stateFlags(const btFemBodyRecord& record);

/// Mismatch of a body's factor for a step [s]: 1 for a fresh factor, else the largest ratio of step or masses, infinity
/// if other nodes are fixed than those of the factor.
double staleness(const btFemBodyRecord& record, double step);

/// A body's own step [s]: Bullet scales time by m_cfg.timescale.
double bodyStep(const btFemBodyRecord& record, double worldStep);

/// Reads the user's changes to the nodes of a FEM body; unusable values are flagged in its report.
void readBody(btFemBodyRecord& record);

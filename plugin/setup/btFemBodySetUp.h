// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "bullet_bridge/body/model_library.h"
#include "bullet_bridge/body/soft_body_mesh.h"
#include "bullet_fem/btFemSolverInfo.h"
#include "bullet_fem/fem/step/stepping.h"
#include "plugin/record/btFemBodyRecord.h"

/// Node masses [kg] from the densities of materials and the rest shape, whatever the present deformation.
std::vector<double> massesAtRest(const bullet_fem::TetMesh& rest, const btSoftBody& body,
                                 const bullet_fem::ElementMaterials& materials);

/// The body's rest mesh and the position of its node 0. Throws std::invalid_argument if the mesh is not usable.
bullet_fem::RestMesh restMeshNow(const btFemBodyRecord& record);

/// True if a body's tetrahedra can become finite elements. Otherwise false, with the reason in `why`. `body` may be
/// null.
bool canBecomeFem(const btSoftBody* body, std::string& why);

/// Makes bodies FEM bodies, and gives them models, that is rest shapes and factors, which bodies share.
class btFemBodySetUp
{
public:
    /// `info` has the size limit and the kind of factors. `announce` is called for each body that has become FEM.
    btFemBodySetUp(const btFemSolverInfo& info, void (*announce)(btSoftBody& body));

    /// Makes the body a FEM body, with a factor for `step` [s]. If it is one already, gives it its changed material or
    /// rest shape. Throws std::invalid_argument or std::runtime_error.
    void setUp(btFemBodyRecord& record, double step);

    /// setUp() for use within a step: a failure is stored in the record, and a new body is left to Bullet.
    void trySetUp(btFemBodyRecord& record, double step);

    /// Prepares self contact if the body has it, and returns whether it has. The first call after it was switched on
    /// costs as much as half of a set-up with a baked factor.
    bool readyForSelfContact(btFemBodyRecord& record);

    /// Sets the collision surface that m_cfg.collisions asks for; costs nothing if that is set already. Throws
    /// std::invalid_argument if the surface is unusable: the mesh's boundary is then used until the choice changes.
    void chooseSurface(btFemBodyRecord& record);

    /// chooseSurface() for use within a step: a failure is stored in the record.
    void tryChooseSurface(btFemBodyRecord& record);

    /// Splits a FEM body between steps: gives it a model of the split mesh with its material, and a new factor for the
    /// former factor's step. Throws like ModelLibrary::model, and changes nothing then.
    void split(btFemBodyRecord& record, const bullet_fem::SplitMesh& split);

    /// Leaves a body that cannot be FEM to Bullet's springs.
    static void reject(btFemBodyRecord& record);

    /// Refactors for the present masses, pins and `step` [s]. Throws like ModelLibrary::model.
    void refactor(btFemBodyRecord& record, double step);

    /// refactor() for use within a step. True if the body has got another factor, which is flagged in its report; a
    /// failure is stored in the record, and the former factor is kept.
    bool tryRefactor(btFemBodyRecord& record, double step);

    /// The input of refactor()'s factorization.
    bullet_fem::FactorInput factorInput(const btFemBodyRecord& record, double step) const;

    /// True if a body has the factor that refactor() needs, so that refactoring costs next to nothing.
    bool knowsFactor(const btFemBodyRecord& record, double step) const;

    /// Gives a body a factor that was made elsewhere for its shape, and flags it in the report.
    void takeFactor(btFemBodyRecord& record, const std::shared_ptr<const bullet_fem::BodyModel>& model);

    /// The rest shape with that hash (see bullet_fem::markOf): the body's own, or that of its present material; null if
    /// neither has it.
    std::shared_ptr<const bullet_fem::RestShape> shapeOf(const btFemBodyRecord& record, std::uint64_t mark);

    /// A model for exactly this shape and input: the body's own, another body's, or a new one. Throws like
    /// BodyModel::create.
    std::shared_ptr<const bullet_fem::BodyModel> exactModel(const btFemBodyRecord& record,
                                                            const std::shared_ptr<const bullet_fem::RestShape>& shape,
                                                            const bullet_fem::FactorInput& input);
    /// Restores a body's factor, and the one before it, which may be null.
    void giveFactors(btFemBodyRecord& record, const std::shared_ptr<const bullet_fem::BodyModel>& model,
                     const std::shared_ptr<const bullet_fem::BodyModel>& former);

private:
    bool canUseBaked(const btFemBodyRecord& record) const;
    double stepOfFactor(double step, const bullet_fem::Material& material) const;
    std::shared_ptr<const bullet_fem::RestShape> bakedShape(const btFemBodyRecord& record,
                                                            const std::vector<double>& filled);
    void setUpNew(btFemBodyRecord& record, double step);
    void renew(btFemBodyRecord& record, double step);
    void exchangeModel(btFemBodyRecord& record, const std::shared_ptr<const bullet_fem::BodyModel>& model);

    void (*m_announce)(btSoftBody& body);
    double m_numericalDamping;  // largest damping of the steps, as in contact, for which factors are made
    bullet_fem::ModelLibrary m_library;
};

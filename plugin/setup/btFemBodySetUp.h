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

/// The masses [kg] that the densities of materials give a body's nodes at rest, however it is deformed now.
std::vector<double> massesAtRest(const bullet_fem::TetMesh& rest, const btSoftBody& body,
                                 const bullet_fem::ElementMaterials& materials);

/// The body's mesh at rest, and where its node 0 is then. Throws std::invalid_argument on an unusable mesh.
bullet_fem::RestMesh restMeshNow(const btFemBodyRecord& record);

/// True if a body's tetrahedra can become finite elements; else `why` says why not. It may be null.
bool canBecomeFem(const btSoftBody* body, std::string& why);

/// Makes bodies FEM bodies, and gives them models: rest shapes and factors, which bodies share.
class btFemBodySetUp
{
public:
    /// How large and of which kind factors may be. `announce` is called with every body that has become FEM.
    btFemBodySetUp(const btFemSolverInfo& info, void (*announce)(btSoftBody& body));

    /// Makes the body a FEM body, factored for `step` [s]; or, if it is one, gives it a changed material or rest shape.
    /// Throws std::invalid_argument or std::runtime_error.
    void setUp(btFemBodyRecord& record, double step);

    /// setUp for use within a step: a failure is written to the record, and the body left to Bullet.
    void trySetUp(btFemBodyRecord& record, double step);

    /// Whether the body touches itself; what that needs is made where it was switched on since the body was set up, and
    /// costs as much as half of a set-up with a baked factor.
    bool readyForSelfContact(btFemBodyRecord& record);

    /// Makes that of a FEM body collide which its m_cfg.collisions asks for; costs nothing if it is so already. Throws
    /// std::invalid_argument if the surface cannot collide: then the mesh's boundary does until it is asked anew.
    void chooseSurface(btFemBodyRecord& record);

    /// chooseSurface for use within a step: a failure is written to the record.
    void tryChooseSurface(btFemBodyRecord& record);

    /// Splits a FEM body between steps: gives it a model of the split mesh, with its material and a new factor for the
    /// step that the old one is for. Throws what ModelLibrary::model throws, and changes nothing then.
    void split(btFemBodyRecord& record, const bullet_fem::SplitMesh& split);

    /// Leaves a body that cannot be FEM to Bullet.
    static void reject(btFemBodyRecord& record);

    /// Factors anew for the present masses, pins and `step` [s]. Throws what ModelLibrary::model throws.
    void refactor(btFemBodyRecord& record, double step);

    /// refactor for use within a step: true if the body has got another factor, which is flagged in its report; a
    /// failure is written to the record, and the old one kept.
    bool tryRefactor(btFemBodyRecord& record, double step);

    /// What refactor would make a factor for.
    bullet_fem::FactorInput factorInput(const btFemBodyRecord& record, double step) const;

    /// True if some body has the factor that refactor would make, so that it costs next to nothing.
    bool knowsFactor(const btFemBodyRecord& record, double step) const;

    /// Gives a body a factor made elsewhere for its shape, and flags that in its report.
    void takeFactor(btFemBodyRecord& record, const std::shared_ptr<const bullet_fem::BodyModel>& model);

    /// The rest shape of that mark (see bullet_fem::markOf) that the body has, or gets with its present material; null
    /// if that is none of them.
    std::shared_ptr<const bullet_fem::RestShape> shapeOf(const btFemBodyRecord& record, std::uint64_t mark);

    /// A factor for exactly this: the body's own, or another's, or a new one. Throws what BodyModel::create throws.
    std::shared_ptr<const bullet_fem::BodyModel> exactModel(const btFemBodyRecord& record,
                                                            const std::shared_ptr<const bullet_fem::RestShape>& shape,
                                                            const bullet_fem::FactorInput& input);
    /// The same, but null if nobody has it.
    std::shared_ptr<const bullet_fem::BodyModel> findExactModel(
        const std::shared_ptr<const bullet_fem::RestShape>& shape, const bullet_fem::FactorInput& input) const
    {
        return m_library.findExact(shape, input);
    }

    /// Gives a body the factor that it had, and the one before that, which may be null.
    void giveFactors(btFemBodyRecord& record, const std::shared_ptr<const bullet_fem::BodyModel>& model,
                     const std::shared_ptr<const bullet_fem::BodyModel>& former);

private:
    bool canUseBaked(const btFemBodyRecord& record) const;
    std::shared_ptr<const bullet_fem::RestShape> bakedShape(const btFemBodyRecord& record,
                                                            const std::vector<double>& filled);
    void setUpNew(btFemBodyRecord& record, double step);
    void renew(btFemBodyRecord& record, double step);
    void exchangeModel(btFemBodyRecord& record, const std::shared_ptr<const bullet_fem::BodyModel>& model);

    void (*m_announce)(btSoftBody& body);
    double m_numericalDamping;  // of the steps that factors are made for: those in contact take most
    bullet_fem::ModelLibrary m_library;
};

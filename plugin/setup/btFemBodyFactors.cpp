// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// btFemBodySetUp: factors of FEM bodies.
#include <algorithm>
#include <utility>

#include "bullet_bridge/body/soft_body_mesh.h"
#include "bullet_fem/fem/body/body_snapshot.h"
#include "fem/common/reason.h"
#include "fem/common/single.h"
#include "plugin/setup/btFemBodySetUp.h"

using namespace bullet_fem;

// Bullet passes the step of set-up to predictMotion(float(timeStep)): in double precision, too, a factor is made for
// the step in single precision, so that its bits do not depend on the caller that requests it first.
double btFemBodySetUp::stepOfFactor(double step, const Material& material) const
{
    return roundedToSingle(factorStep(step, m_numericalDamping, material));
}

FactorInput btFemBodySetUp::factorInput(const btFemBodyRecord& record, double step) const
{
    FactorInput input;
    input.m_mass = record.fem().m_body.m_state.m_mass;
    input.m_fixed = record.fem().m_body.m_state.m_fixed;
    input.m_step = stepOfFactor(step, record.fem().m_body.m_model->shape().m_material);
    return m_library.limited(std::move(input));
}

bool btFemBodySetUp::knowsFactor(const btFemBodyRecord& record, double step) const
{
    return m_library.find(record.fem().m_body.m_model->sharedShape(), factorInput(record, step)) != nullptr;
}

void btFemBodySetUp::refactor(btFemBodyRecord& record, double step)
{
    exchangeModel(record, m_library.model(record.fem().m_body.m_model->sharedShape(), factorInput(record, step)));
}

bool btFemBodySetUp::tryRefactor(btFemBodyRecord& record, double step)
{
    try
    {
        refactor(record, step);
        record.m_model.m_message.clear();
        record.m_reports.m_step.m_flags |= BT_FEM_REFACTORED;
        return true;
    }
    catch (const std::exception& error)
    {
        record.m_model.m_message = reasonOf(error);
        return false;
    }
}

void btFemBodySetUp::takeFactor(btFemBodyRecord& record, const std::shared_ptr<const BodyModel>& model)
{
    exchangeModel(record, m_library.adopt(model));
    record.m_model.m_message.clear();
    record.m_reports.m_step.m_flags |= BT_FEM_REFACTORED;
}

std::shared_ptr<const RestShape> btFemBodySetUp::shapeOf(const btFemBodyRecord& record, std::uint64_t mark)
{
    const BodyModel& model = *record.fem().m_body.m_model;
    if (markOf(model.shape()) == mark) return model.sharedShape();
    const auto shape = m_library.restShape(model.mesh(), materialsOf(record), filledFractionsOf(*record.m_softBody));
    return markOf(*shape) == mark ? shape : nullptr;
}

std::shared_ptr<const BodyModel> btFemBodySetUp::exactModel(const btFemBodyRecord& record,
                                                            const std::shared_ptr<const RestShape>& shape,
                                                            const FactorInput& input)
{
    const std::shared_ptr<const BodyModel>& own = record.fem().m_body.m_model;
    if (own->sharedShape() == shape && own->factorInput() == input) return own;
    return m_library.exactModel(shape, input);
}

void btFemBodySetUp::giveFactors(btFemBodyRecord& record, const std::shared_ptr<const BodyModel>& model,
                                 const std::shared_ptr<const BodyModel>& former)
{
    exchangeModel(record, model);
    record.m_model.m_formerModel = former;
    record.m_model.m_formerCompliance = former ? m_library.compliance(former, record.fem().m_skin.get()) : nullptr;
}

void btFemBodySetUp::exchangeModel(btFemBodyRecord& record, const std::shared_ptr<const BodyModel>& model)
{
    FemSoftBody& fem = record.fem();
    if (model == fem.m_body.m_model) return;
    record.m_model.m_formerModel = fem.m_body.m_model;
    record.m_model.m_formerCompliance = fem.m_compliance;
    fem.m_body.setModel(model);
    fem.m_compliance = m_library.compliance(model, fem.m_skin.get());
}

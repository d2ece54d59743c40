// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "bullet_fem/fem/body_model.h"

#include <chrono>
#include <stdexcept>

#include "fem/elements/model_elements.h"
#include "fem/factor/rest_factor.h"
#include "fem/message.h"

namespace bullet_fem
{
namespace
{

void validateInput(const RestShape& shape, const FactorInput& input)
{
    const std::size_t n = shape.m_mesh.restPositions().size();
    if (!(input.m_step >= 1e-6 && input.m_step <= 1))
        reject("time step ", input.m_step,
               " s is not in [1e-6, 1]; give the fixed step that the world is simulated with");
    if (input.m_mass.size() != n || input.m_fixed.size() != n)
        throw std::invalid_argument("factor input: " + std::to_string(input.m_mass.size()) + " masses and " +
                                    std::to_string(input.m_fixed.size()) + " fixed flags given for " +
                                    std::to_string(n) + " nodes");
    for (std::size_t i = 0; i < n; ++i)
        if (!(input.m_mass[i] > 0) || !std::isfinite(input.m_mass[i]))
            reject("mass of node ", i, " is ", input.m_mass[i], " kg, not in (0, inf)");
    for (std::size_t i = 0; i < n; ++i)
        if (shape.m_mesh.isLoose(static_cast<int>(i)) && !input.m_fixed[i])
            reject("node ", i, " belongs to no element and is not fixed; fix it, or remove it from the mesh");
}

}  // namespace

std::shared_ptr<const BodyModel> BodyModel::create(std::shared_ptr<const RestShape> shape, FactorInput input)
{
    const auto start = std::chrono::steady_clock::now();
    if (!shape) throw std::invalid_argument("BodyModel: the rest shape is null");
    validateInput(*shape, input);
    std::shared_ptr<BodyModel> model(new BodyModel);
    model->m_shape = std::move(shape);
    model->m_input = std::move(input);
    model->m_factor = std::make_unique<const RestFactor>(*model->m_shape, model->m_input, model->m_report);
    model->m_elements = std::make_unique<const ModelElements>(*model->m_shape);
    model->m_report.m_seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    return model;
}

BodyModel::~BodyModel() = default;

}  // namespace bullet_fem

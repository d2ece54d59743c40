// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "bullet_fem/fem/factor/body_model.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "fem/common/bounds.h"
#include "fem/common/message.h"
#include "fem/elements/model_elements.h"
#include "fem/factor/rest_factor.h"
#include "fem/factor/rest_modes.h"

namespace bullet_fem
{
namespace
{

void validateInput(const RestShape& shape, const FactorInput& input)
{
    const std::size_t n = shape.m_mesh.restPositions().size();
    if (!isUsableStep(input.m_step))
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

// With mean dilatation in one material only, the other may be as soft in some volume changes as without lambda.
double mismatchOfPatches(const Material& a, const Material& b)
{
    double most = 1;
    for (const Material* m : {&a, &b}) most = std::max(most, 1 + 1.5 * m->lameLambda() / m->lameMu());
    return most;
}

// Equivalent ratio of steps of two materials. The eigenvalues of A0 lie between those of its parts: 1 + h alpha times
// the mass, and h^2 + h beta times K, which is monotone in the eigenvalues 2 mu and 3 lambda + 2 mu of Hooke's matrix.
// A ratio of steps changes them by its square.
double mismatch(const Material& a, const Material& b, double h)
{
    const auto parts = [h](const Material& m)
    {
        const double stiff = h * h + h * m.m_stiffnessDamping;
        return std::array<double, 3>{1 + h * m.m_massDamping, stiff * m.lameMu(),
                                     stiff * (3 * m.lameLambda() + 2 * m.lameMu())};
    };
    double most = a.usesMeanDilatation() == b.usesMeanDilatation() ? 1 : mismatchOfPatches(a, b);
    for (std::size_t k = 0; k < 3; ++k) most = std::max({most, parts(a)[k] / parts(b)[k], parts(b)[k] / parts(a)[k]});
    return std::sqrt(most);
}

// The equivalent ratio if a material is orthotropic, by the generalized eigenvalues of the two matrices C.
double orthotropicMismatch(const Material& a, const Material& b, double h)
{
    if (a == b) return 1;
    const double patches = a.usesMeanDilatation() == b.usesMeanDilatation() ? 1 : mismatchOfPatches(a, b);
    using Matrix6 = Eigen::Matrix<double, 6, 6>;
    const auto stiff = [h](const Material& m) -> Matrix6
    {
        const ElasticMatrix C = m.stiffness();
        return (h * h + h * m.m_stiffnessDamping) * Eigen::Map<const Matrix6>(&C.m[0][0]);
    };
    const auto mass = [h](const Material& m) { return 1 + h * m.m_massDamping; };
    const Eigen::GeneralizedSelfAdjointEigenSolver<Matrix6> eigen(stiff(a), stiff(b), Eigen::EigenvaluesOnly);
    const double least = eigen.eigenvalues()(0), largest = eigen.eigenvalues()(5);
    return std::sqrt(std::max({patches, mass(a) / mass(b), mass(b) / mass(a), largest, 1 / least}));
}

// Both matrices are sums over elements: their eigenvalues differ by at most the worst element's ratio.
double mismatch(const RestShape& shape, const ElementMaterials& given, double h)
{
    const ElementMaterials own = shape.chosenMaterials(), factored = given.withBending(shape.m_isThin);
    const bool orthotropic = shape.isOrthotropic() || factored.isOrthotropic();
    const auto ofPair = [&](const Material& a, const Material& b)
    { return orthotropic ? orthotropicMismatch(a, b, h) : mismatch(a, b, h); };
    if (shape.m_materials.isUniform() && factored.isUniform()) return ofPair(own.first(), factored.first());
    double most = 1;
    for (int e = 0; e < shape.m_mesh.tetCount(); ++e) most = std::max(most, ofPair(own.of(e), factored.of(e)));
    return most;
}

}  // namespace

std::shared_ptr<const BodyModel> BodyModel::create(std::shared_ptr<const RestShape> shape, FactorInput input)
{
    const auto start = std::chrono::steady_clock::now();
    if (!shape) throw std::invalid_argument("BodyModel: the rest shape is null");
    validateInput(*shape, input);
    std::shared_ptr<BodyModel> model(new BodyModel);
    model->m_shape = std::move(shape);
    FactorOfModel& factor = model->m_factor;
    factor.m_input = std::move(input);
    factor.m_materials = model->m_shape->m_materials;
    factor.m_factor = std::make_shared<const RestFactor>(*model->m_shape, factor.m_input, factor.m_report);
    model->m_restModes = std::make_unique<const RestModes>(*model);
    model->m_elements = std::make_unique<const ModelElements>(*model->m_shape);
    factor.m_report.m_seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    return model;
}

std::shared_ptr<const BodyModel> BodyModel::withFactor(std::shared_ptr<const RestShape> shape, FactorOfModel factor)
{
    if (!shape || !factor.m_factor) throw std::invalid_argument("BodyModel: the rest shape or the factor is null");
    if (static_cast<int>(factor.m_input.m_mass.size()) != shape->m_mesh.nodeCount())
        reject("the factor is one for ", factor.m_input.m_mass.size(), " nodes, and the shape has ",
               shape->m_mesh.nodeCount());
    factor.m_materials.validate(shape->m_mesh.tetCount());
    std::shared_ptr<BodyModel> model(new BodyModel);
    model->m_shape = std::move(shape);
    model->m_factor = std::move(factor);
    model->m_restModes = std::make_unique<const RestModes>(*model);
    model->m_elements = std::make_unique<const ModelElements>(*model->m_shape);
    model->m_materialMismatch = mismatch(*model->m_shape, model->m_factor.m_materials, model->m_factor.m_input.m_step);
    return model;
}

BodyModel::~BodyModel() = default;

}  // namespace bullet_fem

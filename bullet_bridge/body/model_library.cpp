// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "bullet_bridge/body/model_library.h"

#include <algorithm>
#include <cmath>

#include "bullet_bridge/body/collision_skin.h"
#include "bullet_fem/fem/contact/contact_solver.h"

namespace bullet_fem
{
namespace
{

// Largest difference of equal rest positions over the mean edge [-]: rounding in single precision some hundred metres
// from the origin.
constexpr double kSameShape = 1e-4;

// Largest relative difference of equal masses [-]: they come from volumes of edges that differ as above.
constexpr double kSameMass = 1e-3;

// Largest relative difference of equal time steps [-]: Bullet reports the step first in single precision, later in its
// own.
constexpr double kSameStep = 1e-6;

// True if the model's factor may be used for the input as if it were new.
bool serves(const BodyModel& model, const FactorInput& input)
{
    const FactorInput& factored = model.factorInput();
    if (model.materialMismatch() > 1) return false;
    const auto same = [](double a, double b) { return std::fabs(a - b) <= kSameMass * b; };
    return std::fabs(factored.m_step - input.m_step) <= kSameStep * input.m_step && factored.m_fixed == input.m_fixed &&
           std::equal(factored.m_mass.begin(), factored.m_mass.end(), input.m_mass.begin(), input.m_mass.end(), same);
}

bool sameUpToTranslation(const TetMesh& a, const TetMesh& b)
{
    if (a.nodeCount() != b.nodeCount() || a.tets() != b.tets()) return false;
    const std::vector<Vec3>&X = a.restPositions(), &Y = b.restPositions();
    const double tolerance = kSameShape * a.meanEdgeLength();
    for (std::size_t i = 1; i < X.size(); ++i)
        if (norm((X[i] - X[0]) - (Y[i] - Y[0])) > tolerance) return false;
    return true;
}

template <typename Entry, typename Pointer>
void dropDead(std::vector<Entry>& entries, Pointer Entry::*pointer)
{
    const auto dead = [pointer](const Entry& e) { return (e.*pointer).expired(); };
    entries.erase(std::remove_if(entries.begin(), entries.end(), dead), entries.end());
}

}  // namespace

std::shared_ptr<const RestShape> ModelLibrary::restShape(const TetMesh& mesh, const ElementMaterials& materials,
                                                         const std::vector<double>& filled)
{
    dropDead(m_shapes, &Shape::m_shape);
    for (const Shape& entry : m_shapes)
        if (const auto shape = entry.m_shape.lock())
            if (shape->m_materials == materials && entry.m_filled == filled && sameUpToTranslation(shape->m_mesh, mesh))
                return shape;
    const auto shape = std::make_shared<const RestShape>(mesh, materials, filled);
    m_shapes.push_back({shape, filled, {}});
    return shape;
}

std::shared_ptr<const RestShape> ModelLibrary::adoptShape(const std::shared_ptr<const RestShape>& shape,
                                                          const std::vector<double>& filled)
{
    dropDead(m_shapes, &Shape::m_shape);
    for (const Shape& entry : m_shapes)
        if (const auto known = entry.m_shape.lock())
            if (known == shape || (known->m_materials == shape->m_materials && entry.m_filled == filled &&
                                   sameUpToTranslation(known->m_mesh, shape->m_mesh)))
                return known;
    m_shapes.push_back({shape, filled, {}});
    return shape;
}

std::shared_ptr<const BodyModel> ModelLibrary::modelWithFactor(const std::shared_ptr<const RestShape>& shape,
                                                               const FactorInput& input,
                                                               const std::shared_ptr<const BodyModel>& factored)
{
    if (auto known = find(shape, input)) return known;
    dropDead(m_models, &Model::m_model);
    for (const Model& entry : m_models)
        if (auto model = entry.m_model.lock())
            if (model->sharedShape() == shape && &model->factor() == &factored->factor()) return model;
    const bool own = factored->sharedShape() == shape;
    const auto model = own ? factored : BodyModel::withFactor(shape, factored->sharedFactor());
    m_models.push_back({model, {}});
    return model;
}

std::shared_ptr<const BodyModel> ModelLibrary::model(const std::shared_ptr<const RestShape>& shape,
                                                     const FactorInput& input)
{
    if (auto known = find(shape, input)) return known;
    return adopt(BodyModel::create(shape, limited(input)));
}

FactorInput ModelLibrary::limited(FactorInput input) const
{
    input.m_maxBytes = m_maxFactorBytes;
    input.m_choice = m_choice;
    return input;
}

std::shared_ptr<const BodyModel> ModelLibrary::find(const std::shared_ptr<const RestShape>& shape,
                                                    const FactorInput& input) const
{
    for (const Model& entry : m_models)
        if (auto model = entry.m_model.lock())
            if (model->sharedShape() == shape && serves(*model, input)) return model;
    return nullptr;
}

std::shared_ptr<const BodyModel> ModelLibrary::findExact(const std::shared_ptr<const RestShape>& shape,
                                                         const FactorInput& input) const
{
    for (const Model& entry : m_models)
        if (auto model = entry.m_model.lock())
            if (model->sharedShape() == shape && model->factorInput() == input && model->materialMismatch() == 1)
                return model;
    return nullptr;
}

std::shared_ptr<const BodyModel> ModelLibrary::exactModel(const std::shared_ptr<const RestShape>& shape,
                                                          const FactorInput& input)
{
    if (auto known = findExact(shape, input)) return known;
    dropDead(m_models, &Model::m_model);
    const auto model = BodyModel::create(shape, limited(input));
    m_models.push_back({model, {}});
    return model;
}

std::shared_ptr<const BodyModel> ModelLibrary::adopt(std::shared_ptr<const BodyModel> model)
{
    if (auto known = find(model->sharedShape(), model->factorInput())) return known;
    dropDead(m_models, &Model::m_model);
    m_models.push_back({model, {}});
    return model;
}

template <class T, class Make>
std::shared_ptr<T> ModelLibrary::findOrMake(Shared<T>& known, const CollisionSkin* skin, const Make& make)
{
    dropDead(known, &OfNodes<T>::m_shared);
    const std::vector<int> nodes = skin ? skin->nodes() : std::vector<int>();
    for (const OfNodes<T>& entry : known)
        if (entry.m_nodes == nodes)
            if (auto shared = entry.m_shared.lock()) return shared;
    std::shared_ptr<T> made = make();
    known.push_back({nodes, made});
    return made;
}

std::shared_ptr<const RestNeighbours> ModelLibrary::restNeighbours(const std::shared_ptr<const RestShape>& shape,
                                                                   const CollisionSkin* skin)
{
    const TetMesh& mesh = shape->m_mesh;
    const auto make = [&]
    { return std::make_shared<const RestNeighbours>(mesh, skin ? skin->nodes() : mesh.surfaceNodes()); };
    for (Shape& entry : m_shapes)
        if (entry.m_shape.lock() == shape) return findOrMake(entry.m_neighbours, skin, make);
    return make();
}

std::shared_ptr<ComplianceCache> ModelLibrary::compliance(const std::shared_ptr<const BodyModel>& model,
                                                          const CollisionSkin* skin)
{
    const auto make = [&] { return skin ? makeComplianceCache(model, skin->nodes()) : makeComplianceCache(model); };
    for (Model& entry : m_models)
        if (entry.m_model.lock() == model) return findOrMake(entry.m_compliance, skin, make);
    return make();
}

}  // namespace bullet_fem

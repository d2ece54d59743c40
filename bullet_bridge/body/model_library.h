// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <memory>
#include <vector>

#include "bullet_bridge/geometry/surface/rest_neighbours.h"
#include "bullet_fem/fem/factor/body_model.h"

namespace bullet_fem
{

class CollisionSkin;
class ComplianceCache;

/// Finds models that bodies can share: equal elements, materials, masses, pins and step, and rest positions that differ
/// by a translation, up to the rounding of Bullet's single precision. Models live as long as a body uses them.
class ModelLibrary
{
public:
    /// `maxFactorBytes`: largest memory of a factor [B], 0 for no limit. `choice`: kind of the factors.
    explicit ModelLibrary(std::size_t maxFactorBytes = 0, FactorChoice choice = FactorChoice::full)
        : m_maxFactorBytes(maxFactorBytes), m_choice(choice)
    {
    }

    /// A rest shape equal to this one: a known one if it exists, otherwise a new one. Throws like RestShape's
    /// constructor.
    std::shared_ptr<const RestShape> restShape(const TetMesh& mesh, const ElementMaterials& materials,
                                               const std::vector<double>& filled);

    /// A known shape equal to this one if it exists; otherwise registers the shape and returns it.
    std::shared_ptr<const RestShape> adoptShape(const std::shared_ptr<const RestShape>& shape,
                                                const std::vector<double>& filled);

    /// A model of that shape for masses that are equal up to rounding. Factorizes if there is none. Throws like
    /// BodyModel::create.
    std::shared_ptr<const BodyModel> model(const std::shared_ptr<const RestShape>& shape, const FactorInput& input);

    /// The model of that shape and input (masses equal up to rounding), or null.
    std::shared_ptr<const BodyModel> find(const std::shared_ptr<const RestShape>& shape,
                                          const FactorInput& input) const;

    /// A model of that shape for exactly this input. Factorizes if there is none. Throws like BodyModel::create.
    std::shared_ptr<const BodyModel> exactModel(const std::shared_ptr<const RestShape>& shape,
                                                const FactorInput& input);
    /// The model of that shape for exactly this input, or null.
    std::shared_ptr<const BodyModel> findExact(const std::shared_ptr<const RestShape>& shape,
                                               const FactorInput& input) const;

    /// A known model equal to this one if it exists; otherwise registers the model and returns it.
    std::shared_ptr<const BodyModel> adopt(std::shared_ptr<const BodyModel> model);

    /// A model of that shape with a given factor, which may be for another step, masses, pins or material. Returns a
    /// known model with a fitting factor instead if it exists.
    std::shared_ptr<const BodyModel> modelWithFactor(const std::shared_ptr<const RestShape>& shape,
                                                     const FactorInput& input,
                                                     const std::shared_ptr<const BodyModel>& factored);

    /// True if a factor of this size [B] is within the library's limit.
    bool allows(std::size_t bytes) const { return m_maxFactorBytes == 0 || bytes <= m_maxFactorBytes; }

    /// The input with the library's memory limit and kind of factors.
    FactorInput limited(FactorInput input) const;

    /// The neighbours at rest that bodies of a shape share. `skin`: collision surface whose nodes are used; null: the
    /// mesh's boundary.
    std::shared_ptr<const RestNeighbours> restNeighbours(const std::shared_ptr<const RestShape>& shape,
                                                         const CollisionSkin* skin = nullptr);

    /// The compliance cache that bodies of a model share if their collision surfaces depend on equal sets of nodes.
    /// `skin`: collision surface; null: the mesh's boundary.
    std::shared_ptr<ComplianceCache> compliance(const std::shared_ptr<const BodyModel>& model,
                                                const CollisionSkin* skin = nullptr);

private:
    template <class T>
    struct OfNodes
    {
        std::vector<int> m_nodes;  // nodes of a skin; empty: the mesh's boundary
        std::weak_ptr<T> m_shared;
    };
    template <class T>
    using Shared = std::vector<OfNodes<T>>;
    struct Shape
    {
        std::weak_ptr<const RestShape> m_shape;
        std::vector<double> m_filled;
        Shared<const RestNeighbours> m_neighbours;
    };
    struct Model
    {
        std::weak_ptr<const BodyModel> m_model;
        Shared<ComplianceCache> m_compliance;
    };
    template <class T, class Make>
    static std::shared_ptr<T> findOrMake(Shared<T>& known, const CollisionSkin* skin, const Make& make);

    std::size_t m_maxFactorBytes;
    FactorChoice m_choice;
    std::vector<Shape> m_shapes;
    std::vector<Model> m_models;
};

}  // namespace bullet_fem

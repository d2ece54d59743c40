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

/// Finds the models that bodies can share: the same elements, materials, masses, pins and step, and rest positions that
/// differ by a translation, up to the rounding of Bullet's single precision. Models live as long as a body uses them.
class ModelLibrary
{
public:
    /// Factors may take so much memory each [B], 0 for any amount, and are of the kind that was chosen.
    explicit ModelLibrary(std::size_t maxFactorBytes = 0, FactorChoice choice = FactorChoice::full)
        : m_maxFactorBytes(maxFactorBytes), m_choice(choice)
    {
    }

    /// A shape like this, an old one if there is one. Throws what RestShape's constructor throws.
    std::shared_ptr<const RestShape> restShape(const TetMesh& mesh, const ElementMaterials& materials,
                                               const std::vector<double>& filled);

    /// A shape that was made elsewhere, or one like it that is here already.
    std::shared_ptr<const RestShape> adoptShape(const std::shared_ptr<const RestShape>& shape,
                                                const std::vector<double>& filled);

    /// A model of that shape, for masses that differ by rounding at most; factors if there is none yet. Throws what
    /// BodyModel::create throws.
    std::shared_ptr<const BodyModel> model(const std::shared_ptr<const RestShape>& shape, const FactorInput& input);

    /// The model of that shape, or null if there is none yet.
    std::shared_ptr<const BodyModel> find(const std::shared_ptr<const RestShape>& shape,
                                          const FactorInput& input) const;

    /// A model of that shape for exactly these masses; factors if there is none. Throws what BodyModel::create throws.
    std::shared_ptr<const BodyModel> exactModel(const std::shared_ptr<const RestShape>& shape,
                                                const FactorInput& input);
    /// Null if there is none.
    std::shared_ptr<const BodyModel> findExact(const std::shared_ptr<const RestShape>& shape,
                                               const FactorInput& input) const;

    /// A model that was made elsewhere, or one like it that is here already.
    std::shared_ptr<const BodyModel> adopt(std::shared_ptr<const BodyModel> model);

    /// A model of that shape with a factor that may be for another step, masses, pins or material. One that fits better
    /// is taken if it is here.
    std::shared_ptr<const BodyModel> modelWithFactor(const std::shared_ptr<const RestShape>& shape,
                                                     const FactorInput& input,
                                                     const std::shared_ptr<const BodyModel>& factored);

    /// True if a factor of this size is within the library's limit [B].
    bool allows(std::size_t bytes) const { return m_maxFactorBytes == 0 || bytes <= m_maxFactorBytes; }

    /// The input with the library's limit and choice of factors.
    FactorInput limited(FactorInput input) const;

    /// The neighbours at rest that the surfaces of a shape's bodies share. A `skin` has those of the nodes that it
    /// follows; null: the mesh's boundary collides.
    std::shared_ptr<const RestNeighbours> restNeighbours(const std::shared_ptr<const RestShape>& shape,
                                                         const CollisionSkin* skin = nullptr);

    /// The compliance cache that the bodies of a model share which touch with the same nodes.
    std::shared_ptr<ComplianceCache> compliance(const std::shared_ptr<const BodyModel>& model,
                                                const CollisionSkin* skin = nullptr);

private:
    template <class T>
    struct OfNodes
    {
        std::vector<int> m_nodes;  // of a skin; empty: of the boundary
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

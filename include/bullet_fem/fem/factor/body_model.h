// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "bullet_fem/fem/common/export.h"
#include "bullet_fem/fem/mesh/rest_shape.h"

namespace bullet_fem
{

class RestFactor;
class RestModes;
struct ModelElements;

/// The rest factor that preconditions a body's steps. Conjugate gradients reach the tolerance with either.
enum class FactorPath
{
    full,  ///< factor of A0 itself: one or two iterations a step
    /// Factor of mass and a scalar Laplacian, shared by the three directions. The factor takes about a ninth of the
    /// memory and a tenth of the time to factor; A0 itself takes half to all of the factor's memory again. Some ten
    /// times the iterations; the first contact of a node takes ten to twenty times as long.
    lowMemory
};

/// Selection of the factor path. Any factor larger than FactorInput::m_maxBytes is refused.
enum class FactorChoice
{
    full,             ///< always the full factor
    lowMemoryBeyond,  ///< the full factor, or the low-memory path if the full one would exceed m_maxBytes
    lowMemory         ///< always the low-memory path
};

/// The inputs of a rest factor. Bodies with equal inputs share one model.
struct FactorInput
{
    std::vector<double> m_mass;  ///< per node [kg], finite and > 0
    /// Per node, 1 where the velocity is prescribed (pinned node); these are eliminated.
    std::vector<unsigned char> m_fixed;
    double m_step = 1.0 / 60;  ///< h [s], in [1e-6, 1]
    /// Maximum memory of the packed factor [B]; 0: unlimited. Not compared: bodies that differ in it share a factor.
    std::size_t m_maxBytes = 0;
    FactorChoice m_choice = FactorChoice::full;  ///< not compared either

    /// True if step, masses and fixed nodes are equal: one factor fits both.
    friend bool operator==(const FactorInput& a, const FactorInput& b)
    {
        return a.m_step == b.m_step && a.m_mass == b.m_mass && a.m_fixed == b.m_fixed;
    }
};

/// Figures of a factorization.
struct FactorReport
{
    std::string m_backend;                 ///< fill-reducing ordering libraries and their versions
    std::string m_ordering;                ///< library whose order was used: AMD, METIS or Eigen
    long m_entries = 0;                    ///< number of entries of the full factor L, fill included
    int m_supernodes = 0;                  ///< number of dense panels of L
    FactorPath m_path = FactorPath::full;  ///< factor that was built
    std::size_t m_bytes = 0;               ///< memory of its packed panels [B], without A0 on the low-memory path
    std::size_t m_fullBytes = 0;           ///< memory of the full factor, built or not [B]
    /// Wall time of assembly, ordering, factorization and packing [s]; 0 for a baked factor.
    double m_seconds = 0;
    bool m_baked = false;  ///< read from a file (baked_body.h) instead of computed
};

/// A factor with its inputs.
struct FactorOfModel
{
    /// The factor of A0; not null.
    std::shared_ptr<const RestFactor> m_factor;
    /// Step, masses and fixed nodes of the factor.
    FactorInput m_input;
    /// The materials of the factor.
    ElementMaterials m_materials;
    /// Figures of the factorization.
    FactorReport m_report;
};

/// The constant part of a body: its rest shape and the factor of A0 = (1 + h alpha) M + (h^2 + h beta) K. Immutable;
/// may be shared by bodies and threads.
class BULLETFEM_API BodyModel
{
public:
    /// Builds the factor. Several threads may call it at once; orderings are serialised, because METIS seeds and draws
    /// from the global random generator (std::rand). If the program draws meanwhile, another order of similar quality
    /// may result. Throws std::invalid_argument naming the value on a bad step, mass or array size; std::runtime_error
    /// if A0 cannot be factored or the factor would exceed input.m_maxBytes (found before it is computed). Allocates.
    static std::shared_ptr<const BodyModel> create(std::shared_ptr<const RestShape> shape, FactorInput input);
    /// A model with an existing factor of a shape with equally many nodes. If the factor's material differs, it is a
    /// stale preconditioner, which costs iterations. Throws std::invalid_argument if the factor is null or has another
    /// number of nodes. Allocates.
    static std::shared_ptr<const BodyModel> withFactor(std::shared_ptr<const RestShape> shape, FactorOfModel factor);
    ~BodyModel();

    /// The rest shape: mesh, materials, masses.
    const RestShape& shape() const { return *m_shape; }
    /// The rest shape, for sharing.
    const std::shared_ptr<const RestShape>& sharedShape() const { return m_shape; }
    /// The mesh.
    const TetMesh& mesh() const { return m_shape->m_mesh; }
    /// The inputs of the factor.
    const FactorInput& factorInput() const { return m_factor.m_input; }
    /// The factor of A0; the type is internal.
    const RestFactor& factor() const { return *m_factor.m_factor; }
    /// The factor with its inputs, for sharing.
    const FactorOfModel& sharedFactor() const { return m_factor; }
    /// The rigid modes of the rest shape; the type is internal.
    const RestModes& restModes() const { return *m_restModes; }
    /// Elements in the kernels' layout; the type is internal.
    const ModelElements& elements() const { return *m_elements; }
    /// Figures of the factorization.
    const FactorReport& factorReport() const { return m_factor.m_report; }
    /// Mismatch of the factor's material [-]: 1 if it is the shape's, else the equivalent ratio of steps, > 1, at the
    /// worst element. Does not include masses or densities.
    double materialMismatch() const { return m_materialMismatch; }
    /// Number of nodes of the mesh, loose ones included.
    int nodeCount() const { return m_shape->m_mesh.nodeCount(); }

private:
    BodyModel() = default;
    std::shared_ptr<const RestShape> m_shape;
    FactorOfModel m_factor;
    std::unique_ptr<const RestModes> m_restModes;
    std::unique_ptr<const ModelElements> m_elements;
    double m_materialMismatch = 1;
};

}  // namespace bullet_fem

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
struct ModelElements;

/// Which factor preconditions the steps of a body. Conjugate gradients iterate to the tolerance with either.
enum class FactorPath
{
    full,      ///< of A0 itself: one or two iterations a step
    lowMemory  ///< of mass and a scalar Laplacian, one for all three directions: about a ninth of the memory, and half
               ///< as much to as much again for A0 itself, a tenth of the time to factor, some ten times the
               ///< iterations; nodes that touch something for the first time take ten to twenty times as long
};

/// Who chooses the path. A factor that is larger than FactorInput::m_maxBytes all the same is refused.
enum class FactorChoice
{
    full,             ///< always the full factor
    lowMemoryBeyond,  ///< the full factor, or the low-memory path where it would be larger than m_maxBytes
    lowMemory         ///< always the low-memory path
};

/// What a rest factor is built for. Bodies that agree in all of it share one model.
struct FactorInput
{
    std::vector<double> m_mass;  ///< per node [kg], finite and > 0
    std::vector<unsigned char>
        m_fixed;               ///< per node, 1 where the velocity is prescribed (pinned); those are eliminated
    double m_step = 1.0 / 60;  ///< h [s], in [1e-6, 1]
    /// Memory that the packed factor may take [B], 0 for any amount. A limit, not a property of the factor: bodies that
    /// differ in it share one.
    std::size_t m_maxBytes = 0;
    FactorChoice m_choice = FactorChoice::full;  ///< likewise not compared

    /// Same step, masses and fixed nodes: one factor does for both.
    friend bool operator==(const FactorInput& a, const FactorInput& b)
    {
        return a.m_step == b.m_step && a.m_mass == b.m_mass && a.m_fixed == b.m_fixed;
    }
};

/// Figures of a factorization.
struct FactorReport
{
    std::string m_backend;                 ///< libraries of fill-reducing orders, with their versions
    std::string m_ordering;                ///< what found the order that was taken: AMD, METIS or Eigen
    long m_entries = 0;                    ///< entries of the full factor L, fill included
    int m_supernodes = 0;                  ///< dense panels that L is packed in
    FactorPath m_path = FactorPath::full;  ///< what was built
    std::size_t m_bytes = 0;               ///< memory of its packed panels [B], without A0 on the low-memory path
    std::size_t m_fullBytes = 0;           ///< what the full factor takes, or would have taken [B]
    double m_seconds = 0;  ///< wall time of assembly, ordering, factorization and packing [s]; 0 of a baked factor
    bool m_baked = false;  ///< it was not made here, but read from a file (see baked_body.h)
};

/// A factor with what it was made for.
struct FactorOfModel
{
    /// Of A0; not null.
    std::shared_ptr<const RestFactor> m_factor;
    /// Step, masses and fixed nodes.
    FactorInput m_input;
    /// The materials.
    ElementMaterials m_materials;
    /// Figures of the factorization.
    FactorReport m_report;
};

/// A body's const half: its rest shape and the factor of A0 = (1 + h alpha) M + (h^2 + h beta) K. Immutable, so it may
/// be shared by bodies and threads.
class BULLETFEM_API BodyModel
{
public:
    /// Builds the factor. May be called by several threads, which order one after another, because METIS seeds the
    /// global random generator (std::rand) and draws from it: programs that draw at the same time get other factors,
    /// that do as well. Throws
    /// std::invalid_argument naming the value on a bad step, mass or array size, std::runtime_error if A0 cannot be
    /// factored or its factor would be larger than input.m_maxBytes (said before it is computed).
    static std::shared_ptr<const BodyModel> create(std::shared_ptr<const RestShape> shape, FactorInput input);
    /// A model with a factor that was made before, for a shape of the same nodes; of another material, too: then it is
    /// a stale one, which costs iterations. Throws std::invalid_argument if there is none, or for another number of
    /// nodes.
    static std::shared_ptr<const BodyModel> withFactor(std::shared_ptr<const RestShape> shape, FactorOfModel factor);
    ~BodyModel();

    /// Mesh, material, masses.
    const RestShape& shape() const { return *m_shape; }
    /// The same, to be shared.
    const std::shared_ptr<const RestShape>& sharedShape() const { return m_shape; }
    /// The mesh.
    const TetMesh& mesh() const { return m_shape->m_mesh; }
    /// What the factor was made for.
    const FactorInput& factorInput() const { return m_factor.m_input; }
    /// The factor of A0; its type is not public.
    const RestFactor& factor() const { return *m_factor.m_factor; }
    /// The same with what it was made for, to be shared.
    const FactorOfModel& sharedFactor() const { return m_factor; }
    /// Elements as kernels read them; their type is not public.
    const ModelElements& elements() const { return *m_elements; }
    /// Figures of the factorization.
    const FactorReport& factorReport() const { return m_factor.m_report; }
    /// By how much the factor's material is off [-]: 1 if it is the shape's, else the ratio of steps that would be as
    /// bad, > 1, at the worst of the elements. Masses, and so the density, are not in it.
    double materialMismatch() const { return m_materialMismatch; }
    /// Nodes of the mesh, loose ones included.
    int nodeCount() const { return m_shape->m_mesh.nodeCount(); }

private:
    BodyModel() = default;
    std::shared_ptr<const RestShape> m_shape;
    FactorOfModel m_factor;
    std::unique_ptr<const ModelElements> m_elements;
    double m_materialMismatch = 1;
};

}  // namespace bullet_fem

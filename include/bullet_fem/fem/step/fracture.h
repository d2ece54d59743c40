// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <array>
#include <memory>
#include <vector>

#include "bullet_fem/fem/body/body.h"
#include "bullet_fem/fem/common/export.h"
#include "bullet_fem/fem/step/stress.h"

namespace bullet_fem
{

/// Limits of fracture in one step.
struct FractureLimits
{
    double m_strength = 0;  ///< tensile strength of a cut through the elements around a node [Pa], > 0
    int m_mostCracks = 1;   ///< maximum number of cracks that begin in a step, >= 1
};

/// A connected set of element faces that separate.
struct Crack
{
    Vec3 m_place;         ///< node where the crack begins [m]
    Vec3 m_normal;        ///< unit direction of the maximum tension there
    double m_stress = 0;  ///< tension there [Pa], above the strength
    double m_area = 0;    ///< area of the faces in the present shape [m2], > 0
    int m_faces = 0;      ///< number of faces, > 0
};

/// The connectivity of a mesh after splitting.
struct SplitMesh
{
    std::vector<Tet> m_tets;  ///< node indices of every element, in the mesh's order
    /// Source node of each copied node, ascending; copies are numbered after the mesh's nodes in this order.
    std::vector<int> m_copyOf;
    std::vector<Crack> m_cracks;  ///< in the order of detection
};

/// Fracture criterion and crack growth: a body breaks between elements, at nodes where a cut across the maximum tension
/// carries more than the strength (docs/materials.md, Splitting). One object serves one mesh; find() grows its scratch
/// when cracks are found.
class BULLETFEM_API Fracture
{
public:
    /// Prepares fracture of one shape, not null. Allocates.
    explicit Fracture(std::shared_ptr<const RestShape> shape);

    /// The rest shape whose mesh may break.
    const std::shared_ptr<const RestShape>& shape() const { return m_shape; }

    /// Tests whether the body, which must have this shape, splits in its present state; writes `split` only then.
    /// Allocates only then. The result does not depend on the number of threads.
    bool find(const Body& body, const FractureLimits& limits, SplitMesh& split);

private:
    struct Cut  // a planar cut through the elements around a node
    {
        Vec3 m_normal;
        double m_stress = 0;  // [Pa]
        bool m_isThere = false;
    };
    struct Begin
    {
        int m_node;
        double m_stress;
    };

    bool markTense(double strength);
    void listBegins(const Body& body, double strength);
    Cut cutAt(const Body& body, int node, const Vec3& along);
    int sideOf(const Body& body, int element, const Vec3& x, const Vec3& normal) const;
    Vec3 tensionAt(int node) const;
    void open(const Body& body, int node, const Vec3& normal, Crack& crack);
    Crack grow(const Body& body, const Begin& begin, double strength);
    bool isNearCrack(int node) const;
    void part(int node, SplitMesh& split) const;

    std::shared_ptr<const RestShape> m_shape;
    const TetMesh& m_mesh;
    std::vector<int> m_first, m_around;           // elements around every node, ascending
    std::vector<std::array<int, 4>> m_neighbour;  // neighbour behind the side opposite each node; -1: none
    std::vector<Stress> m_stress;                 // per element [Pa]
    std::vector<unsigned char> m_isTense;         // per node: an adjacent element carries a good part of the strength
    std::vector<Begin> m_begins;
    std::vector<signed char> m_side;       // per element: side of this step's cracks, 1 or -1; 0: not at a crack
    std::vector<signed char> m_sideHere;   // per element: side of the cut under test, 1 or -1; 0: not at it
    std::vector<unsigned char> m_isCut;    // per element: bit a is set if the side opposite its node a is cut
    std::vector<unsigned char> m_isAtCut;  // per node
    std::vector<int> m_front;              // nodes at the crack front
};

/// Node masses after splitting [kg], one a node, copies last: each node's mass is divided between the node and its
/// copies by the filled volumes of their elements. `filled`: one fraction an element in (0, 1], or empty if all are 1;
/// `mass`: one a node of the mesh [kg]. Allocates.
BULLETFEM_API std::vector<double> splitMasses(const TetMesh& mesh, const SplitMesh& split,
                                              const std::vector<double>& filled, const std::vector<double>& mass);

/// The body with a model of the split mesh, in its present motion. Fibres and expansions are carried over, cables and
/// chambers are not. `copyOf` is SplitMesh::m_copyOf. Allocates.
BULLETFEM_API Body splitBody(const Body& body, std::shared_ptr<const BodyModel> model, const std::vector<int>& copyOf);

}  // namespace bullet_fem

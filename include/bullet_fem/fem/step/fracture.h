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

/// When a body splits.
struct FractureLimits
{
    double m_strength = 0;  ///< tension that a cut through the elements around a node bears [Pa], > 0
    int m_mostCracks = 1;   ///< that begin in a step, >= 1
};

/// Faces between elements that part together.
struct Crack
{
    Vec3 m_place;         ///< the node where it begins [m]
    Vec3 m_normal;        ///< the direction of the largest tension there, a unit vector
    double m_stress = 0;  ///< tension there [Pa], beyond the strength
    double m_area = 0;    ///< of the faces as they are now [m2], > 0
    int m_faces = 0;      ///< > 0
};

/// How the elements of a mesh join nodes once it has split.
struct SplitMesh
{
    std::vector<Tet> m_tets;      ///< in the mesh's order, and in that of their nodes
    std::vector<int> m_copyOf;    ///< nodes of the mesh, ascending: copies come after the mesh's nodes in this order
    std::vector<Crack> m_cracks;  ///< in the order in which they were found
};

/// Finds where a body breaks: between elements, at nodes around which a cut across the largest tension bears more than
/// the strength (docs/materials.md, Splitting). Of one mesh; find() grows its scratch when cracks are found.
class BULLETFEM_API Fracture
{
public:
    /// `shape` is not null. Allocates.
    explicit Fracture(std::shared_ptr<const RestShape> shape);

    /// Whose mesh it is.
    const std::shared_ptr<const RestShape>& shape() const { return m_shape; }

    /// True if the body, which has this shape, splits as it is now; `split` is written then and not otherwise.
    /// Allocates only then. The same for any number of threads.
    bool find(const Body& body, const FractureLimits& limits, SplitMesh& split);

private:
    struct Cut  // through the elements around a node
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
    std::vector<std::array<int, 4>> m_neighbour;  // behind the side opposite each node; -1: none
    std::vector<Stress> m_stress;                 // of every element [Pa]
    std::vector<unsigned char> m_isTense;         // per node: of an element that bears a good part of the strength
    std::vector<Begin> m_begins;
    std::vector<signed char> m_side;       // per element: of the cracks of this step, 1 or -1; 0: of none
    std::vector<signed char> m_sideHere;   // per element: likewise of the cut that is looked at
    std::vector<unsigned char> m_isCut;    // per element: bit a of the side opposite its node a
    std::vector<unsigned char> m_isAtCut;  // per node
    std::vector<int> m_front;              // nodes that a crack has come to
};

/// Masses once it has split [kg]: those of nodes and copies, shares of what the node weighed by the (filled) volumes of
/// the elements that they keep. `filled`: fractions; empty: all 1.
BULLETFEM_API std::vector<double> splitMasses(const TetMesh& mesh, const SplitMesh& split,
                                              const std::vector<double>& filled, const std::vector<double>& mass);

/// The body with a model of the split mesh, in the motion that it is in. Fibres and expansions are carried over, cables
/// and chambers are not. Allocates.
BULLETFEM_API Body splitBody(const Body& body, std::shared_ptr<const BodyModel> model, const std::vector<int>& copyOf);

}  // namespace bullet_fem

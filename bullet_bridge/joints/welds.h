// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <array>
#include <utility>
#include <vector>

#include "bullet_bridge/body/fem_soft_body.h"
#include "bullet_bridge/rigid/sorted_index.h"

namespace bullet_fem
{

/// Matching faces of two bodies, with coincident corners.
struct CommonFaces
{
    std::vector<std::pair<int, int>> m_nodes;  ///< pairs of nodes of the first body and of the other, ascending
    std::vector<double> m_area;                ///< per pair: a third of the area of its faces at present [m2]
    std::vector<std::array<int, 3>> m_faces;   ///< nodes of the first body, oriented outward
};

/// The matching faces of two bodies at their present positions, with corners at most `reach` [m] apart.
CommonFaces commonFaces(const FemSoftBody& a, const FemSoftBody& b, double reach);

/// Welds the bodies at these faces by attachments. `weld` has the limits; its handle, faces and other body are set
/// here. `compliance`: that of a layer between the bodies [m/Pa], >= 0. Returns the handle.
int addWeld(FemSoftBody& a, const FemSoftBody& b, const CommonFaces& faces, Weld weld, double compliance);

/// Finds the groups of bodies that are connected by welds, and their welded nodes. Call find() in every step before
/// contact searches; grows with the number of bodies.
class WeldClusters
{
public:
    void find(const std::vector<FemSoftBody*>& bodies, const std::vector<FemSoftBody*>& others);

private:
    int root(int body) const;
    int indexOf(const NodeAttachment& tie) const;

    std::vector<FemSoftBody*> m_bodies;
    SortedIndex<const btSoftBody*> m_byAddress;
    std::vector<int> m_parent;
};

/// False for bodies of one group of welds, unless both have CL_SELF: they count as one body.
bool mayTouch(const FemSoftBody& a, const FemSoftBody& b);

/// True if both points have welded nodes of one group, where contact would act against welds. Bodies with a common edge
/// or corner only are as close there as welded ones.
bool areWelded(const FemSoftBody& a, const SurfacePoint& pointOfA, const FemSoftBody& b, const SurfacePoint& pointOfB);

/// The load of a weld in the last step.
struct WeldLoad
{
    int m_nodes = 0;       ///< number of its attachments
    double m_area = 0;     ///< their area [m2]
    Vec3 m_force;          ///< force on the body with the weld [N]
    double m_stress = 0;   ///< largest traction of a node by tension and shear, see docs/materials.md [Pa], >= 0
    double m_stretch = 0;  ///< largest distance of a pair of nodes as the step began [m], >= 0
};

/// A weld of which attachments broke in a step.
struct WeldBreak
{
    int m_weld = 0;                       ///< handle
    const btSoftBody* m_other = nullptr;  ///< the other body of the weld
    int m_broken = 0;                     ///< number of attachments that broke
    WeldLoad m_load;                      ///< load before the break; its m_nodes and m_area are those left
};

/// Loads of welds after the step is solved. Scratch grows with the largest body.
class WeldLoads
{
public:
    /// The load in a step of `step` [s]. Call after SoftJoints::takeBack. The reference is valid until the next call.
    const WeldLoad& load(const FemSoftBody& fem, const Weld& weld, double step);

    /// Removes attachments beyond a weld's limits, and appends the weld to `broken`.
    void breakWelds(FemSoftBody& fem, double step, std::vector<WeldBreak>& broken);

private:
    struct Tie
    {
        int m_index;  // index in HeldJoints::m_attachments
        double m_stress, m_stretch;
    };
    void findNormals(const FemSoftBody& fem, const Weld& weld);

    std::vector<Vec3> m_normal;  // per node, sum of the outward area vectors of welded faces
    std::vector<Tie> m_ties;
    WeldLoad m_load;
};

}  // namespace bullet_fem

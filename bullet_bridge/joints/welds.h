// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <array>
#include <utility>
#include <vector>

#include "bullet_bridge/body/fem_soft_body.h"

namespace bullet_fem
{

/// Faces that two bodies have in common: their corners lie in the same places.
struct CommonFaces
{
    std::vector<std::pair<int, int>> m_nodes;  ///< of the first body and of the other, ascending
    std::vector<double> m_area;                ///< of every such pair: a third of its faces, as they are now [m2]
    std::vector<std::array<int, 3>> m_faces;   ///< nodes of the first body, counter-clockwise seen from outside of it
};

/// Those of the surfaces of two bodies as they lie, with corners at most `reach` [m] apart.
CommonFaces commonFaces(const FemSoftBody& a, const FemSoftBody& b, double reach);

/// Ties the bodies by these faces: `weld` has the limits; its handle, faces and other body are given to it here.
/// `compliance` is that of a layer between them [m/Pa], >= 0. Returns the handle.
int addWeld(FemSoftBody& a, const FemSoftBody& b, const CommonFaces& faces, Weld weld, double compliance);

/// Finds the clusters of all bodies of a world and their welded nodes, in every step, before contacts are searched.
class WeldClusters
{
public:
    void find(const std::vector<FemSoftBody*>& bodies, const std::vector<FemSoftBody*>& others);

private:
    int root(int body) const;
    int indexOf(const NodeAttachment& tie) const;

    std::vector<FemSoftBody*> m_bodies;
    std::vector<std::pair<const btSoftBody*, int>> m_byAddress;
    std::vector<int> m_parent;
};

/// False for pieces that hang together by welds: as one body, they touch each other only if they have CL_SELF.
bool mayTouch(const FemSoftBody& a, const FemSoftBody& b);

/// True if contact between these points would push on what welds hold: both have welded nodes, of one cluster. Pieces
/// that have an edge or a corner in common lie there as close as those that are welded.
bool areWelded(const FemSoftBody& a, const SurfacePoint& pointOfA, const FemSoftBody& b, const SurfacePoint& pointOfB);

/// What a weld bore in the last step.
struct WeldLoad
{
    int m_nodes = 0;       ///< that it still ties
    double m_area = 0;     ///< that it still holds [m2]
    Vec3 m_force;          ///< on the body that has it [N]
    double m_stress = 0;   ///< the largest of a node: tension and shear, see docs/materials.md [Pa], >= 0
    double m_stretch = 0;  ///< the largest distance of two nodes, as the step began [m], >= 0
};

/// What broke in a step.
struct WeldBreak
{
    int m_weld = 0;                       ///< handle
    const btSoftBody* m_other = nullptr;  ///< of the weld
    int m_broken = 0;                     ///< ties that broke
    WeldLoad m_load;                      ///< before they broke; its number of nodes is what is left
};

/// Welds of bodies whose step is solved. Scratch only; grows with the largest body.
class WeldLoads
{
public:
    /// Of a step of `step` [s], after SoftJoints::takeBack.
    const WeldLoad& load(const FemSoftBody& fem, const Weld& weld, double step);

    /// Unties what bears more than its limit, and appends it to `broken`.
    void breakWelds(FemSoftBody& fem, double step, std::vector<WeldBreak>& broken);

private:
    struct Tie
    {
        int m_index;  // in HeldJoints::m_attachments
        double m_stress, m_stretch;
    };
    void findNormals(const FemSoftBody& fem, const Weld& weld);

    std::vector<Vec3> m_normal;  // per node, of the faces at it, outward
    std::vector<Tie> m_ties;
    WeldLoad m_load;
};

}  // namespace bullet_fem

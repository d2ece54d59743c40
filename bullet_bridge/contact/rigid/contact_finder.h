// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include "LinearMath/btAlignedObjectArray.h"
#include "bullet_bridge/body/fem_soft_body.h"
#include "bullet_bridge/contact/contact_reduction.h"
#include "bullet_bridge/contact/rigid/carried_motion.h"
#include "bullet_bridge/contact/rigid/sheet_touch.h"
#include "bullet_bridge/contact/rigid/surface_culling.h"
#include "bullet_bridge/contact/warm_start_transfer.h"
#include "bullet_bridge/geometry/shapes/shape_distance.h"
#include "bullet_bridge/geometry/shapes/swept_distance.h"
#include "bullet_bridge/rigid/rigid_proxies.h"

namespace bullet_fem
{

/// Flags of a contact search.
struct ContactSearchReport
{
    bool m_unknownShape = false;  ///< a shape without contact support was left out
    bool m_limited = false;       ///< more contacts than permitted were found; those of smallest gap were kept
};

/// A flat face of a moving object that slides on soft bodies.
struct CarryingPlane
{
    bool m_exists = false;
    Vec3 m_normal;          ///< unit, out of the object
    double m_distance = 0;  ///< of the plane from the origin, along the normal, as the step begins [m]
};

/// An object near a body, as input of the contact search.
struct TouchedObject
{
    const btCollisionObject* m_object;
    int m_rigidProxy;              ///< index of its rigid proxy
    int m_firstLeaf, m_leafCount;  ///< leaves of its shape, posed as its rigid proxy is
    bool m_unknownShape;           ///< a part of its shape has no contact support
    CarryingPlane m_carrying;
};

/// Input of a body's contact search.
struct RigidSurroundings
{
    const TouchedObject* m_touched;  ///< objects near the body, by ascending broadphase id, m_count of them
    int m_count;
    const btAlignedObjectArray<ShapeLeaf>& m_leaves;
    const std::vector<RigidProxy>& m_rigidProxies;
    double m_step;      ///< time step [s]
    int m_maxContacts;  ///< largest number of contacts of the body
};

/// Records that Bullet's broad phase found the two overlapping, once. May be called by several threads at once.
void recordTouching(FemSoftBody& fem, const btCollisionObject& object);
/// Records an overlap with another FEM body, on one body of the pair, once. May be called by several threads at once.
void recordTouching(FemSoftBody& fem, const btSoftBody& other);

/// Finds the contacts of a FEM body's surface with the recorded objects, present or possible within the step.
/// Features: every shape is tested with surface nodes. Convex shapes are also tested with midpoints of edges and
/// triangles where the nodes do not all lie over one flat face, and with the nearest points of edges and triangles
/// where these are closer than all fixed points. Fixed points come first because the nearest point, and the contact
/// force with it, wanders where edges or faces are parallel. On triangles below the corners of a small polyhedron, the
/// corners replace the nearest point.
/// Gaps are measured between the surface as the step begins and the objects' poses; pairs that separate faster than
/// they could close within the step are left out (speculative contact). Impulses of the last step are the warm start.
///
/// Fast motion: if surface and shape move farther within the step than half a mesh edge or half the shape's thickness,
/// gaps and normals of its beginning are meaningless. Then a feature is a contact if the paths meet, with the normal at
/// that time (swept_distance.h). Pairs that do not touch yet are contacts only if the paths meet.
///
/// Flush surfaces: paths are limited by present contacts (carried_motion.h), so a sliding vertex moves along its
/// carrier, a contact band above it, and does not hit the side of the next box. A side wall that does not rise above a
/// surface that carries the point is dropped. Objects that slide over soft bodies sink in; walls in front of their side
/// that rise little above the face that they lie on are dropped as well (CarryingPlane).
///
/// Concave shapes are sheets of two-sided triangles (sheet_touch.h). A node stays on the side that it came from, which
/// is remembered while it is near. A node without a history is on its present side; if it is less than the contact band
/// beyond a sheet, it is on the side of its body.
///
/// Scratch grows with the surface and the number of triangles, never shrinks.
class ContactFinder
{
public:
    /// Call after solveFreeMotion. Replaces fem.m_contacts and fem.m_origins by those of this step, at most
    /// m_maxContacts, with m_soft.m_body = bodyIndex. Writes to `fem` only. Returns the search's flags.
    ContactSearchReport find(FemSoftBody& fem, int bodyIndex, const RigidSurroundings& around);

private:
    /// Contact parameters of a pair of surfaces; see ContactPoint for the units.
    struct Surface
    {
        double m_hardness = 1, m_friction = 0, m_restitution = 0, m_stiffness = 0, m_damping = 0;
    };
    enum class TargetKind
    {
        slow,   // convex; neither shape nor body moves far within the step
        fast,   // convex; contacts are searched on the paths
        sheets  // two-sided triangles
    };
    /// One leaf of an object's shape to be tested, with its motion and the step.
    struct Target
    {
        const ShapeLeaf* m_shape;
        const btCollisionObject* m_object;
        int m_leaf;                  // index among the object's leaves
        int m_rigidProxy;            // index of the object's rigid proxy
        const RigidProxy* m_motion;  // as the step begins
        Vec3 m_moved;  // displacement of its centre that Bullet has applied already, of kinematic objects [m]
        Surface m_surface;
        double m_reach;  // distance up to which contact is possible within the step [m]
        Vec3 m_fall;  // displacement by gravity that is missing in the free approach if one of the two is supported [m]
        double m_step;  // [s]
        const CarryingPlane* m_carrying;
        TargetKind m_kind;
        std::size_t m_first, m_end;          // range of its contacts in m_near
        std::size_t m_firstSide, m_endSide;  // range in m_sheetSides, of sheets
    };
    using Weights = std::array<double, 3>;
    static constexpr double kFeatureDepth = 0.3;    // largest depth of edge and triangle contacts, over the mean edge
    static constexpr double kOpposedCosine = -0.5;  // cosine between opposed normals, at most

    static Surface surfaceOf(const btSoftBody& soft, const btCollisionObject& object);
    /// Input of a search for contacts with a leaf along the paths.
    struct PathSearch
    {
        const Target& m_target;
        const SweptShape& m_swept;
        double m_speed;      // largest speed of the surface relative to the leaf [m/s]
        double m_clearance;  // distance that still counts as meeting [m]
    };
    /// Input of a search for contacts with the sheets of one leaf.
    struct SheetSearch
    {
        FemSoftBody& m_fem;
        const Target& m_target;
        double m_thickness;  // of the sheet, plus the contact offset [m]
    };

    void findOnNodes(FemSoftBody& fem, const Target& target);
    void findOnEdges(FemSoftBody& fem, const Target& target);
    void findOnTriangles(FemSoftBody& fem, const Target& target);
    void findOnCorners(FemSoftBody& fem, const Target& target);
    static int firstCornerFeature(const FemSoftBody& fem);
    static int triangleOfCorner(const FemSoftBody& fem, int feature);
    template <class Use>
    void forEachCornerOver(const FemSoftBody& fem, const Target& target, const Triangle& t, const Use& use) const;
    bool isUnderCorner(const FemSoftBody& fem, const Target& target, const Triangle& t) const;
    void findOnSheets(FemSoftBody& fem, const Target& target);
    void makeRoom();
    const RigidProxy& asTheStepBegan(const TouchedObject& touched, const RigidSurroundings& around);
    void listTargets(FemSoftBody& fem, const RigidSurroundings& around);
    void findNear(FemSoftBody& fem, Target& target);
    void findTouchingNodes(FemSoftBody& fem, const Target& target);
    void addCarriers(const FemSoftBody& fem);
    void markFlush(FemSoftBody& fem);
    int surfaceOf(std::size_t target, std::size_t k) const;
    bool isFlush(FemSoftBody& fem, const Target& target, std::size_t k, int surface);
    bool isBesideCarryingPlane(const Target& target, const Vec3& point, const Vec3& normal, double gap) const;
    bool isPassed(const FemSoftBody& fem, const Target& target, std::size_t k, int surface);
    bool isFlushWith(const Target& target, const ContactPoint& contact, const Vec3& onPlane, const Vec3& normal);
    bool nearestOn(const Target& target, const Vec3& point, const ContactPoint& contact, Vec3& nearest);
    void findWithinStep(FemSoftBody& fem, const Target& target);
    static Vec3 fallOf(const FemSoftBody& fem, const Target& target);
    SweptFeature pathOf(const FemSoftBody& fem, const Triangle& nodes, const Vec3& held, double step) const;
    static SweptShape sweptShapeOf(const Target& target);
    bool isFastTarget(const FemSoftBody& fem, const Target& target) const;
    static Triangle cornersOf(const FemSoftBody& fem, const Target& target, int feature);
    void findOnPaths(FemSoftBody& fem, const Target& target);
    bool meets(const FemSoftBody& fem, const PathSearch& search, const Triangle& nodes, SweptContact& contact) const;
    bool meetsIfHeld(const FemSoftBody& fem, const PathSearch& search, const Triangle& nodes, const Vec3& held,
                     SweptContact& contact) const;
    void setLevers(const FemSoftBody& fem, const Target& target, int feature, const SweptContact& met,
                   ContactPoint& contact) const;
    double considerPath(FemSoftBody& fem, const PathSearch& search, int feature, const Triangle& nodes,
                        double earliest);
    void measureSurface(const FemSoftBody& fem);
    bool collectSheets(const FemSoftBody& fem, const Target& target);
    void findOnSheetPaths(FemSoftBody& fem, const Target& target);
    bool isTurned(const SheetSearch& search, int node, Vec3& way) const;
    void considerSheetPath(const SheetSearch& search, int node, const Vec3& way, const Vec3& rightSide,
                           std::size_t first);
    void keepNear(std::size_t k);
    void findOnSheetNodes(const SheetSearch& search);
    void findOnSheetEdges(const SheetSearch& search);
    void findOnSheetTriangles(const SheetSearch& search);
    Vec3 wayOf(const SheetSearch& search, int node) const;
    Vec3 rightSideOf(const SheetSearch& search, int node, const Vec3& position) const;
    Vec3 safePosition(const SheetSearch& search, int node, const Vec3& position) const;
    void considerTouches(const SheetSearch& search, int feature, const Triangle& nodes);
    static bool faces(const FemSoftBody& fem, const Triangle& nodes, const Vec3& normal);
    bool isFar(const Target& target, const Triangle& nodes) const;
    bool overOneFace(const FemSoftBody& fem, int a, int b) const;
    double gapAt(const FemSoftBody& fem, const Target& target, const Triangle& nodes, const Weights& weights,
                 SurfaceDistance& d) const;
    static ContactOrigin originOf(const Target& target, int feature);
    static const ContactPoint* pushing(const FemSoftBody& fem, const ContactOrigin& origin);
    void holdBack(const FemSoftBody& fem, const Triangle& nodes, const ContactPoint& last, const Weights& nearest,
                  double step);
    double considerNearest(FemSoftBody& fem, const Target& target, int feature, const Triangle& nodes, double nearest);
    void consider(FemSoftBody& fem, const Target& target, int feature, const Triangle& nodes, const SurfaceDistance& d);
    Vec3 patchOf(const FemSoftBody& fem, const Target& target, int node, const Vec3& normal, double time) const;
    ContactPoint* keep(FemSoftBody& fem, const Target& target, int feature, const Triangle& nodes,
                       const SurfaceDistance& d);
    void begin(const FemSoftBody& fem, int bodyIndex);
    void noteHeld(const FemSoftBody& fem);
    void thin(const FemSoftBody& fem, const RigidSurroundings& around);
    void takeOverImpulses(const FemSoftBody& fem);
    void inheritImpulses(const FemSoftBody& fem);

    std::vector<Target> m_targets;
    std::vector<RigidProxy> m_starts;  // proxies of kinematic objects as the step begins
    std::vector<ContactPoint> m_contacts;
    std::vector<ContactOrigin> m_origins;
    std::vector<Weights> m_weights;    // barycentric weights of m_contacts on their features' corners
    std::vector<ContactPoint> m_near;  // contacts as the step begins, and candidates within the step
    std::vector<ContactOrigin> m_nearOrigins;
    std::vector<Weights> m_nearWeights;
    std::vector<unsigned char> m_flush;  // per entry of m_near: it is dropped as flush
    CarriedMotion m_carried;
    std::vector<Vec3> m_heldNormal;  // per vertex, normal of its strongest contact in the last step; 0: none
    std::vector<double> m_heldBy;    // impulse of that contact [N s]
    std::vector<int> m_lainOn;       // triangles below corners of the present target
    std::vector<int> m_order;
    std::vector<unsigned char> m_continued;  // per contact of the last step: its impulse was taken over
    WarmStartTransfer m_transfer;
    ContactReduction m_reduction;
    SurfaceCulling m_culling;
    TriangleSoup m_soup;
    std::vector<SheetTouch> m_touches;
    std::vector<SheetSide> m_sheetSides;
    std::vector<Vec3> m_outward;      // unit normals of the nodes
    std::vector<Vec3> m_edgeOutward;  // per edge, sum of the unit normals of both triangles
    bool m_measured = false;          // m_outward and m_edgeOutward are up to date
    double m_edge = 0;                // mean edge length [m]
    double m_size = 0;                // cube root of the body's volume [m]
    double m_advantage = 0;           // by which a nearest point must be closer than the fixed ones [m]
    double m_fastest = 0;             // fastest node of the body [m/s]
    double m_band = 0;                // gaps below this are contacts whether or not they close [m]
    int m_bodyIndex = 0;
};

}  // namespace bullet_fem

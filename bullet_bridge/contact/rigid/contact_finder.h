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

/// What a search for contacts found besides them.
struct ContactSearchReport
{
    bool m_unknownShape = false;  ///< a shape without contact support was left out
    bool m_limited = false;       ///< more points than allowed were found; those with the smallest gaps were kept
};

/// A flat face of a moving object, by which soft bodies carry it.
struct CarryingPlane
{
    bool m_exists = false;
    Vec3 m_normal;          ///< unit, out of the object
    double m_distance = 0;  ///< of the plane from the origin, along the normal [m]
};

/// An object that a body may touch.
struct TouchedObject
{
    const btCollisionObject* m_object;
    int m_rigidProxy;              ///< its index
    int m_firstLeaf, m_leafCount;  ///< of its shape, where its rigid proxy is
    bool m_unknownShape;           ///< some of its shape has no contact support
    CarryingPlane m_carrying;
};

/// What a body's contacts are searched among.
struct RigidSurroundings
{
    const TouchedObject* m_touched;  ///< objects near the body, by ascending broadphase id
    int m_count;
    const btAlignedObjectArray<ShapeLeaf>& m_leaves;
    const std::vector<RigidProxy>& m_rigidProxies;
    double m_step;      ///< [s]
    int m_maxContacts;  ///< of the body
};

/// Remembers that Bullet's broad phase found the two overlapping. May be called by several threads at once.
void recordTouching(FemSoftBody& fem, const btCollisionObject& object);
/// The same for a FEM body; recorded with one of the two.
void recordTouching(FemSoftBody& fem, const btSoftBody& other);

/// Finds where a FEM body's surface touches the objects recorded, or may do so within the step. Against every shape:
/// surface nodes. Against convex shapes, where the nodes do not lie over one flat face: the middles of edges and
/// triangles, and, where the shape lies between all of these, the nearest points of edges and triangles. Points that
/// are fixed in the surface come first because the nearest point wanders where edges or faces are parallel, and contact
/// forces with it; on triangles below the corners of a polyhedron that is no larger than they are, these take the
/// nearest point's place. Gaps are measured from the positions at the start of the step to the objects' present poses;
/// what separates faster than it could close within the step is left out (speculative contact). Impulses of the last
/// step are taken over as guesses.
///
/// Where the two move farther within the step than half of an edge or of the shape's thickness, these gaps and normals
/// mean little: there a feature is a contact if the paths meet, with the normal of that time (swept_distance.h). What
/// does not touch yet is a contact only if the paths meet, too.
///
/// Paths are those that contacts allow (carried_motion.h): a vertex that slides goes along what carries it, a contact
/// band above, and not into the side of the next box. Of what touches, a side wall that does not rise above a surface
/// that carries the point is dropped: it lies flush in it. Objects that slide over soft bodies sink in, and what stands
/// before their side a little above the face that they lie on is dropped likewise (CarryingPlane).
///
/// Concave shapes are sheets of triangles with two sides (sheet_touch.h): a node keeps off them on the side that it
/// came from, which is remembered as long as it is near. One that is seen for the first time is on the side where it
/// is; if it is less than the contact band beyond, on that of its body.
///
/// Scratch grows with the surface and the number of triangles, never shrinks.
class ContactFinder
{
public:
    /// After solveFreeMotion: fem.m_contacts and fem.m_origins become those of this step, with m_soft.m_body =
    /// bodyIndex, at most m_maxContacts. Only `fem` is written to.
    ContactSearchReport find(FemSoftBody& fem, int bodyIndex, const RigidSurroundings& around);

private:
    /// How a pair of surfaces touches; as in ContactPoint.
    struct Surface
    {
        double m_hardness = 1, m_friction = 0, m_restitution = 0, m_stiffness = 0, m_damping = 0;
    };
    enum class TargetKind
    {
        slow,   // convex, and neither it nor the body moves far within the step
        fast,   // convex: contacts are looked for on the paths
        sheets  // of triangles
    };
    /// What is tested against: one shape of an object, its motion, the step.
    struct Target
    {
        const ShapeLeaf* m_shape;
        const btCollisionObject* m_object;
        int m_leaf;                  // among the object's
        int m_rigidProxy;            // its index
        const RigidProxy* m_motion;  // as the step begins
        Vec3 m_moved;                // how far its centre has gone already: that of a kinematic object [m]
        Surface m_surface;
        double m_reach;  // distance at which it may be touched within the step [m]
        Vec3 m_fall;     // by which the two may come nearer than they would freely, if one does not fall [m]
        double m_step;   // [s]
        const CarryingPlane* m_carrying;
        TargetKind m_kind;
        std::size_t m_first, m_end;          // what touches it as the step begins, or may soon, in m_near
        std::size_t m_firstSide, m_endSide;  // of sheets, in m_sheetSides
    };
    using Weights = std::array<double, 3>;
    static constexpr double kFeatureDepth = 0.3;    // of a mean edge: what is deeper came from elsewhere
    static constexpr double kOpposedCosine = -0.5;  // of normals that look against each other

    static Surface surfaceOf(const btSoftBody& soft, const btCollisionObject& object);
    /// A search for contacts with a leaf along the paths.
    struct PathSearch
    {
        const Target& m_target;
        const SweptShape& m_swept;
        double m_speed;      // of the surface relative to the leaf, at most [m/s]
        double m_clearance;  // what comes nearer meets it [m]
    };
    /// A search for contacts with the sheets of one leaf.
    struct SheetSearch
    {
        FemSoftBody& m_fem;
        const Target& m_target;
        double m_thickness;  // of the sheet, with the contact offset [m]
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
    std::vector<RigidProxy> m_starts;  // of kinematic objects, which have moved already
    std::vector<ContactPoint> m_contacts;
    std::vector<ContactOrigin> m_origins;
    std::vector<Weights> m_weights;    // of m_contacts' features' corners, as found near
    std::vector<ContactPoint> m_near;  // as the step begins: what touches, and what may within the step
    std::vector<ContactOrigin> m_nearOrigins;
    std::vector<Weights> m_nearWeights;
    std::vector<unsigned char> m_flush;  // one of each: it is no wall
    CarriedMotion m_carried;
    std::vector<Vec3> m_heldNormal;  // of the strongest contact that a vertex had in the last step; 0: of none
    std::vector<double> m_heldBy;    // its impulse [N s]
    std::vector<int> m_lainOn;       // triangles below corners of the present target
    std::vector<int> m_order;
    std::vector<unsigned char> m_continued;  // contacts of the last step
    WarmStartTransfer m_transfer;
    ContactReduction m_reduction;
    SurfaceCulling m_culling;
    TriangleSoup m_soup;
    std::vector<SheetTouch> m_touches;
    std::vector<SheetSide> m_sheetSides;
    std::vector<Vec3> m_outward;      // of the nodes, unit
    std::vector<Vec3> m_edgeOutward;  // sum of the unit normals of both triangles
    bool m_measured = false;          // m_outward and m_edgeOutward are of this body and step
    double m_edge = 0;                // mean length [m]
    double m_size = 0;                // cube root of the body's volume [m]
    double m_advantage = 0;           // by which a nearest point must beat the fixed ones [m]
    double m_fastest = 0;             // node of the body [m/s]
    double m_band = 0;                // gaps below this are contacts though nothing closes them [m]
    int m_bodyIndex = 0;
};

}  // namespace bullet_fem

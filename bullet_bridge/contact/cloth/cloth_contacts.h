// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <memory>
#include <mutex>
#include <vector>

#include "LinearMath/btAlignedObjectArray.h"
#include "bullet_bridge/contact/cloth/cloth_contact_search.h"
#include "bullet_bridge/contact/cloth/cloth_surface.h"
#include "bullet_fem/fem/contact/contact_solver.h"

class btSoftBody;

namespace bullet_fem
{

class Threads;
struct FemSoftBody;

/// Contact of FEM bodies with cloth: collects the pairs that Bullet's collision detection reports, finds their contacts
/// after Bullet has moved the cloth, and applies the solved impulses to the cloth's nodes. The contact solver sees a
/// cloth node, or a point of a cloth face, as a rigid proxy without rotation; proxies that share nodes are coupled
/// (RigidResponse). Only buffers are kept from step to step. Contacts and their order do not depend on the number of
/// threads.
class ClothContacts
{
public:
    /// A FEM body and a cloth that Bullet's broad phase found together.
    struct Pair
    {
        FemSoftBody* m_fem;
        btSoftBody* m_cloth;
        int m_clothId;    ///< broadphase id
        bool m_mayTouch;  ///< contacts are searched; otherwise the two are attached only
    };

    /// Forgets the pairs of the last step.
    void beginStep();

    /// Adds a pair once. May be called by several threads at once.
    void note(FemSoftBody& fem, btSoftBody& cloth, bool touches = true);

    /// Adds pairs of a body and the cloth among `bodies` that is attached to it, so that its springs are solved with
    /// contact. Removes attachments to cloth that no longer exists, and then sets m_clothIsLost.
    void noteAttached(FemSoftBody& fem, const btAlignedObjectArray<btSoftBody*>& bodies);

    bool hasPairs() const { return !m_pairs.empty(); }

    /// Forgets cloth that is not in `bodies`: it may have been deleted since collision detection.
    void keepOnly(const btAlignedObjectArray<btSoftBody*>& bodies);

    /// Lets Bullet solve the cloth's springs now, at most once a step, if the cloth is in a pair: the contact search
    /// then sees the cloth's final free motion.
    void solveSprings(btSoftBody& cloth);
    /// Solves the springs of any cloth that solveSprings() did not solve in this step.
    void finishSprings(btSoftBody& cloth);

    /// Finds the contacts of `bodies`, after their free motion, with cloth that Bullet has moved already. `step` is the
    /// world's [s]. Keeps at most maxContacts a pair, those of smallest gap.
    void find(const std::vector<FemSoftBody*>& bodies, double step, int maxContacts, const Threads& threads);

    /// True if a pair of body b had more contacts than find() keeps.
    bool isLimited(std::size_t b) const;

    /// Appends contacts and joints to the problem, with a rigid proxy and its responses for each. `step` is the world's
    /// [s].
    void append(double step, ContactProblem& problem);

    /// Moves the cloths' nodes by the impulses of the solved problem that append() wrote to.
    void applyReactions(const ContactProblem& problem);

    /// The contacts that append() appended: their number, the index of the first in the problem, and the sides of
    /// contact k, in [0, size()).
    std::size_t size() const { return m_contactCount; }
    std::size_t first() const { return m_firstContact; }
    int countOf(std::size_t b) const;  ///< contacts of body b
    const btSoftBody& cloth(std::size_t k) const { return m_surfaces[m_holds[k].m_surface]->body(); }
    /// Point of contact k on the body as the step begins [m].
    const Vec3& onBody(std::size_t k) const { return m_holds[k].m_onBody; }

private:
    struct Search  // one pair
    {
        int m_body, m_surface;
        bool m_mayTouch, m_limited;
        std::vector<ClothContact> m_touches;
        std::vector<int> m_order;
    };
    struct Hold  // one proxy: a contact, or the joint of an attachment
    {
        int m_surface;
        Triangle m_nodes;
        std::array<double, 3> m_weights;
        Vec3 m_onBody;
        std::size_t m_row;  // index of the contact or joint in the problem
    };
    struct NodeUse  // a node that a hold has a weight on
    {
        int m_surface, m_node, m_hold;
        double m_weight;

        bool isBeside(const NodeUse& b) const { return m_surface == b.m_surface && m_node == b.m_node; }
        bool operator<(const NodeUse& b) const;
    };

    bool areSpringsSolved(const btSoftBody& cloth) const;
    void listSearches(const std::vector<FemSoftBody*>& bodies);
    int surfaceOf(const Pair& pair);
    void search(const FemSoftBody& fem, int maxContacts, Search& search) const;
    void appendContact(const Search& search, const FemSoftBody& fem, const ClothContact& touch,
                       ContactProblem& problem);
    void appendJoints(const Search& search, double step, ContactProblem& problem);
    int appendProxy(const Hold& hold, const Vec3& at, ContactProblem& problem);
    void listUses();
    void connect(ContactProblem& problem);

    std::mutex m_mutex;  // guards m_pairs: Bullet's threads call note()
    std::vector<Pair> m_pairs;
    std::vector<const btSoftBody*> m_solved;  // cloths whose springs are solved in this step
    std::vector<std::unique_ptr<ClothSurface>> m_surfaces;
    std::vector<unsigned char> m_isUsed, m_isUsable;  // per surface, in this step
    std::vector<std::unique_ptr<Search>> m_searches;
    std::size_t m_searchCount = 0;  // number used in this step; the others keep their buffers
    const std::vector<FemSoftBody*>* m_bodies = nullptr;
    std::vector<Hold> m_holds;  // one per proxy: contacts, then joints
    std::size_t m_contactCount = 0;
    std::vector<NodeUse> m_uses;   // sorted
    std::vector<double> m_answer;  // scratch per hold: inverse mass that couples it to the present hold [1/kg]
    std::vector<int> m_answering;  // scratch: holds coupled to the present one
    std::size_t m_firstContact = 0, m_firstProxy = 0;  // indices in the problem
};

}  // namespace bullet_fem

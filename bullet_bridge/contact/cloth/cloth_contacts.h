// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <memory>
#include <mutex>
#include <vector>

#include "LinearMath/btAlignedObjectArray.h"
#include "bullet_bridge/contact/cloth/cloth_surface.h"
#include "bullet_bridge/contact/cloth/cloth_touch_search.h"
#include "bullet_fem/fem/contact/contact_solver.h"

class btSoftBody;

namespace bullet_fem
{

class Threads;
struct FemSoftBody;

/// Contact of FEM bodies with cloth: pairs that Bullet's collision detection reports, their contacts once Bullet has
/// moved the cloth, and what these do to its nodes. To the contact solver a node of a cloth, or a point of a face of
/// it, is a rigid proxy that does not turn; proxies on the same nodes answer together (RigidResponse). Nothing is
/// remembered from step to step but room. The same contacts in the same order for any number of threads.
class ClothContacts
{
public:
    /// A FEM body and a cloth that Bullet's broad phase found together.
    struct Pair
    {
        FemSoftBody* m_fem;
        btSoftBody* m_cloth;
        int m_clothId;    ///< in the broadphase
        bool m_mayTouch;  ///< contact is looked for; otherwise they are attached only
    };

    /// Forgets the pairs of the last step.
    void beginStep();

    /// May be called by several threads at once.
    void note(FemSoftBody& fem, btSoftBody& cloth, bool touches = true);

    /// Makes pairs of a body and the cloth among `bodies` that is attached to it, whose springs are not solved yet.
    /// Attachments to cloth that is gone are removed, and m_clothIsLost is set.
    void noteAttached(FemSoftBody& fem, const btAlignedObjectArray<btSoftBody*>& bodies);

    bool hasPairs() const { return !m_pairs.empty(); }

    /// Forgets cloth that is not one of `bodies`: it may have gone since collision detection.
    void keepOnly(const btAlignedObjectArray<btSoftBody*>& bodies);

    /// Lets Bullet's springs move a cloth now, once a step, if it is in a pair: its contacts see what it will do, and
    /// hold as the step ends.
    void solveSprings(btSoftBody& cloth);
    /// The same for any cloth, if that was not done.
    void finishSprings(btSoftBody& cloth);

    /// Finds the contacts of `bodies`, after their free motion, with cloth that Bullet has moved already. `step` [s] is
    /// the world's. At most maxContacts a pair are kept, those of smallest gap.
    void find(const std::vector<FemSoftBody*>& bodies, double step, int maxContacts, const Threads& threads);

    /// True if a pair of body b had more contacts than are kept.
    bool isLimited(std::size_t b) const;

    /// Appends contacts and joints to those of the problem, and rigid proxies and responses for them. `step` [s] is the
    /// world's.
    void append(double step, ContactProblem& problem);

    /// The problem that append() wrote to has been solved: moves the nodes of the cloths.
    void applyReactions(const ContactProblem& problem);

    /// Contacts that append() appended: their number, the first in the problem, and what belongs to one.
    std::size_t size() const { return m_contactCount; }
    std::size_t first() const { return m_firstContact; }
    int countOf(std::size_t b) const;  ///< of body b
    const btSoftBody& cloth(std::size_t k) const { return m_surfaces[m_holds[k].m_surface]->body(); }
    const Vec3& onBody(std::size_t k) const { return m_holds[k].m_onBody; }  ///< where it is, as the step begins [m]

private:
    struct Search  // of one pair
    {
        int m_body, m_surface;
        bool m_mayTouch, m_limited;
        std::vector<ClothTouch> m_touches;
        std::vector<int> m_order;
    };
    struct Hold  // a contact, or a joint of an attachment
    {
        int m_surface;
        Triangle m_nodes;
        std::array<double, 3> m_weights;
        Vec3 m_onBody;
        std::size_t m_row;  // index of the contact, or of the joint, in the problem
    };
    struct NodeUse  // a hold has a node
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
    void appendContact(const Search& search, const FemSoftBody& fem, const ClothTouch& touch, ContactProblem& problem);
    void appendJoints(const Search& search, double step, ContactProblem& problem);
    int appendProxy(const Hold& hold, const Vec3& at, ContactProblem& problem);
    void listUses();
    void connect(ContactProblem& problem);

    std::mutex m_mutex;  // guards m_pairs while Bullet's threads collide
    std::vector<Pair> m_pairs;
    std::vector<const btSoftBody*> m_solved;  // springs, in this step
    std::vector<std::unique_ptr<ClothSurface>> m_surfaces;
    std::vector<unsigned char> m_isUsed, m_isUsable;  // per surface, in this step
    std::vector<std::unique_ptr<Search>> m_searches;
    std::size_t m_searchCount = 0;  // of this step; the others keep their room
    const std::vector<FemSoftBody*>* m_bodies = nullptr;
    std::vector<Hold> m_holds;  // one a proxy: contacts, then joints
    std::size_t m_contactCount = 0;
    std::vector<NodeUse> m_uses;                       // ascending
    std::vector<double> m_answer;                      // scratch, per hold [1/kg]
    std::vector<int> m_answering;                      // scratch: holds with an answer
    std::size_t m_firstContact = 0, m_firstProxy = 0;  // in the problem
};

}  // namespace bullet_fem

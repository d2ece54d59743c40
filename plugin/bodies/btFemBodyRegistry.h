// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <memory>
#include <string>
#include <unordered_map>
#include <vector>

#include "LinearMath/btAlignedObjectArray.h"
#include "bullet_bridge/fem_soft_body.h"
#include "bullet_bridge/joints/world_objects.h"
#include "bullet_bridge/model_library.h"
#include "bullet_fem/btFemSoftBodySolver.h"
#include "plugin/contact/btFemBulletContacts.h"
#include "plugin/policy/btFemDetailChooser.h"
#include "plugin/policy/btFemFactorAccount.h"
#include "plugin/policy/btFemRealTime.h"
#include "plugin/sleeping/btFemSleeping.h"

namespace bullet_fem
{
class Threads;
}

struct btFemBaked;
struct btFemDefinition;
struct btFemFactorJob;

/// How far a body has come in a step.
enum class btFemStage
{
    none,       ///< between steps
    predicted,  ///< in predictMotion
    free,       ///< its free motion is solved; contact is not
    solved      ///< contact is solved too, within the rigid solver
};

/// All that the solver knows of one btSoftBody.
struct btFemEntry
{
    explicit btFemEntry(btSoftBody* softBody) : m_softBody(softBody) {}

    btSoftBody* m_softBody;
    const void* m_world = nullptr;        // array of soft bodies of the world that steps it; null while not in a world
    const void* m_formerWorld = nullptr;  // the one it was taken over from
    int m_handedBack = 0;                 // times that the former world claimed it again
    bool m_present = false;               // the world being stepped holds it, and shall step it

    // What the user asked for.
    bullet_fem::Material m_material;
    bool m_materialGiven = false;
    bool m_materialChanged = false;  // the model does not have it yet
    btFemDetail m_detail = btFemDetail::automatic;
    double m_contactOffset = 0;                           // [m]
    std::shared_ptr<const btFemDefinition> m_definition;  // rest shape and masses, until it is set up
    std::shared_ptr<const btFemBaked> m_baked;            // rest shape and factor, likewise

    // What became of it. Without m_fem and without m_rejected it was not tried yet.
    std::unique_ptr<bullet_fem::FemSoftBody> m_fem;
    std::shared_ptr<const bullet_fem::BodyModel> m_formerModel;       // kept, so that a step size that comes and goes
    std::shared_ptr<bullet_fem::ComplianceCache> m_formerCompliance;  // is not factored for again and again
    bool m_rejected = false;
    bool m_asksSkin = false, m_hasAskedSurface = false;  // what the user wanted to collide when that was last looked at
    std::string m_message;
    bool m_wasChanged = false;  // by the program, which appended, removed or rejoined nodes or tetrahedra
    int m_setUpFlags = 0;       // flags that hold until the body is set up anew

    btFemStage m_stage = btFemStage::none;
    btFemStepReport m_report;
    btAlignedObjectArray<btFemContact> m_contacts;
    btAlignedObjectArray<btFemTouch> m_touches;
    btAlignedObjectArray<btFemAnchorReport> m_anchors;
    double m_lastStep = 0;        // [s]
    bool m_isFinished = false;    // its nodes have normals and a speed: see btFemWorldStep::finish
    double m_factorMismatch = 1;  // factorMismatch() as the step began
    double m_staleness = 1;       // staleness() in the free motion
    btFemSleep m_sleep;
    btFemDetailLevel m_detailLevel;
    btFemFactorAccount m_factorAccount;
    std::shared_ptr<btFemFactorJob> m_factorJob;  // the next factor, being made in the background
    btFemRealTime m_realTime;
    btFemFaceIndex m_faceIndex;

    bool isStepped() const { return m_present && m_fem; }
};

/// What a body is made of: what the user said, or what Bullet's fields say.
bullet_fem::Material materialOf(const btFemEntry& entry);

/// The masses [kg] that a density [kg/m3] gives a body's nodes at rest, however it is deformed now. Throws
/// std::invalid_argument on an unusable mesh.
std::vector<double> massesAtRest(const btFemEntry& entry, double density);

/// The bodies of a solver, by address. Removal from a world is silent and addresses are reused, so every step compares
/// what is known with what the world holds.
class btFemBodyRegistry
{
public:
    /// Whether dispatchers of FEM bodies get their manifolds, and how large and of which kind factors may be.
    explicit btFemBodyRegistry(const btFemSolverInfo& info);

    btFemEntry* find(const btSoftBody* body);
    const btFemEntry* find(const btSoftBody* body) const { return const_cast<btFemBodyRegistry*>(this)->find(body); }

    /// The entry of a body, made if there is none. Throws std::invalid_argument on null.
    btFemEntry& entry(btSoftBody* body);

    void forget(const btSoftBody* body);

    /// Makes the entries those of the world's bodies: drops entries of bodies that left it or never came, and those
    /// whose address now holds another body; makes entries for new ones with tetrahedra; flags bodies added twice or
    /// elsewhere. `threads` compare their tetrahedra with what is known.
    void synchronise(const btAlignedObjectArray<btSoftBody*>& softBodies, const btSoftBodySolver* solver,
                     const bullet_fem::Threads& threads);

    /// Makes the body a FEM body, factored for `step` [s]; or, if it is one, gives it a changed material or rest shape.
    /// Throws std::invalid_argument or std::runtime_error.
    void setUp(btFemEntry& entry, double step);

    /// setUp for use within a step: a failure is written to the entry, and the body left to Bullet.
    void trySetUp(btFemEntry& entry, double step);

    /// Whether the body touches itself; what that needs is made where it was switched on since the body was set up, and
    /// costs as much as half of a set-up with a baked factor.
    bool readyForSelfContact(btFemEntry& entry);

    /// Makes that of a FEM body collide which its m_cfg.collisions asks for; costs nothing if it is so already. Throws
    /// std::invalid_argument if the surface cannot collide: then the mesh's boundary does until it is asked anew.
    void chooseSurface(btFemEntry& entry);

    /// chooseSurface for use within a step: a failure is written to the entry.
    void tryChooseSurface(btFemEntry& entry);

    /// Leaves a body that cannot be FEM to Bullet.
    static void reject(btFemEntry& entry);

    /// Factors anew for the present masses, pins and `step` [s]. Throws what ModelLibrary::model throws.
    void refactor(btFemEntry& entry, double step);

    /// refactor for use within a step: true if the body has got another factor, which is flagged in its report; a
    /// failure is written to the entry, and the old one kept.
    bool tryRefactor(btFemEntry& entry, double step);

    /// What refactor would make a factor for.
    bullet_fem::FactorInput factorInput(const btFemEntry& entry, double step) const;

    /// True if some body has the factor that refactor would make, so that it costs next to nothing.
    bool knowsFactor(const btFemEntry& entry, double step) const;

    /// Gives a body a factor made elsewhere for its shape, and flags that in its report.
    void takeFactor(btFemEntry& entry, const std::shared_ptr<const bullet_fem::BodyModel>& model);

    /// True if the address still holds the body that the entry was made for, uncut. The body must not be deleted.
    static bool isAsBuilt(const btFemEntry& entry);

    /// The rest shape of that mark (see bullet_fem::markOf) that the body has, or gets with its present material; null
    /// if that is none of them.
    std::shared_ptr<const bullet_fem::RestShape> shapeOf(const btFemEntry& entry, std::uint64_t mark);

    /// A factor for exactly this: the body's own, or another's, or a new one. Throws what BodyModel::create throws.
    std::shared_ptr<const bullet_fem::BodyModel> exactModel(const btFemEntry& entry,
                                                            const std::shared_ptr<const bullet_fem::RestShape>& shape,
                                                            const bullet_fem::FactorInput& input);
    /// The same, but null if nobody has it.
    std::shared_ptr<const bullet_fem::BodyModel> findExactModel(
        const std::shared_ptr<const bullet_fem::RestShape>& shape, const bullet_fem::FactorInput& input) const
    {
        return m_library.findExact(shape, input);
    }

    /// Gives a body the factor that it had, and the one before that, which may be null.
    void giveFactors(btFemEntry& entry, const std::shared_ptr<const bullet_fem::BodyModel>& model,
                     const std::shared_ptr<const bullet_fem::BodyModel>& former);

    /// Puts some of the entries before all others, in this order.
    void putFirst(const std::vector<btFemEntry*>& entries);

    const std::vector<std::unique_ptr<btFemEntry>>& entries() const { return m_entries; }

    /// True if the world that holds the body holds the object, too, or if that cannot be known. The world is looked at
    /// once after every forgetWorld.
    bool worldHolds(const btSoftBody& body, const btCollisionObject* object);
    void forgetWorld() { m_worldObjects.forget(); }

    /// Looks at the world of the bodies. True if their world infos agree about it: then worldHolds may be called for
    /// any of them by several threads at once.
    bool readWorld(const std::vector<btFemEntry*>& entries);

private:
    std::size_t indexOf(const btSoftBody* body) const;
    void numberEntries();
    bool isAnother(std::size_t known, const btSoftBody& body) const;
    void forgetTheDead(const btAlignedObjectArray<btSoftBody*>& softBodies);
    static void lookAgain(btFemEntry& entry, bool joinedAsBefore);
    void compareTopologies(const btAlignedObjectArray<btSoftBody*>& softBodies, const bullet_fem::Threads& threads);
    void registerWithDispatcher(btSoftBody& body) const;
    bool canUseBaked(const btFemEntry& entry) const;
    std::shared_ptr<const bullet_fem::RestShape> bakedShape(const btFemEntry& entry, const std::vector<double>& filled);
    void setUpNew(btFemEntry& entry, double step);
    void renew(btFemEntry& entry, double step);
    void exchangeModel(btFemEntry& entry, const std::shared_ptr<const bullet_fem::BodyModel>& model);
    void claim(btFemEntry& entry, const void* world, const btSoftBodySolver* solver);

    bool m_showsManifolds;
    std::vector<std::unique_ptr<btFemEntry>> m_entries;           // in the order in which they became known
    std::unordered_map<const btSoftBody*, std::size_t> m_number;  // of every entry
    std::vector<unsigned char> m_held;                            // per entry: the world being stepped holds it
    std::vector<unsigned char> m_joinedAsBefore;  // likewise: its tetrahedra join the nodes that they did
    std::vector<int> m_compared;                  // entries
    bullet_fem::ModelLibrary m_library;
    bullet_fem::WorldObjects m_worldObjects;
};

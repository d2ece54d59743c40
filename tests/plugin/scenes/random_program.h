// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <random>
#include <vector>

#include "bullet_fem/fem/common/vec3.h"
#include "plugin/scenes/soft_world.h"

namespace bullet_fem
{

/// The kind of calls that a random program makes.
enum class Manner
{
    hostile,  ///< any call of the interface, in any order: bodies are torn and crushed, bad values are written
    gentle  ///< the calls of a game: bodies are added, removed, thrown, held, saved and restored; energy stays bounded
};

/// A program of random calls. Equal seeds give equal programs, and the effect of an act depends on its own number only,
/// so that acts can be left out.
class RandomProgram
{
public:
    RandomProgram(WorldClass worldClass, Coupling coupling, unsigned number, Manner manner = Manner::hostile);

    /// Makes a call, or steps. A rejection (std::invalid_argument) is accepted.
    void act(unsigned number);

    /// Name of the last act(), for messages.
    const char* lastAct() const { return m_last; }
    int refusals() const { return m_refusals; }
    long steps() const { return m_steps; }        ///< world steps so far
    bool replayed() const { return m_replayed; }  ///< false: a restored state continued differently, once
    FemWorld& world() { return m_world; }
    const std::vector<btSoftBody*>& soft() const { return m_soft; }  ///< in the world, in the order of addition
    const std::vector<btRigidBody*>& rigid() const { return m_rigid; }

private:
    struct Act
    {
        const char* m_name;
        int m_weight, m_gentleWeight;
        void (RandomProgram::*m_do)();
    };
    static const std::vector<Act>& acts();
    int weight(const Act& act) const { return m_manner == Manner::gentle ? act.m_gentleWeight : act.m_weight; }

    double number(double from, double to);
    double logarithmic(double from, double to);
    int below(int count);
    bool one(int in) { return below(in) == 0; }
    bool bad(int in) { return one(in) && m_manner == Manner::hostile; }  // occasionally
    void stepWorld(int count, double h);
    btVector3 vector(double size);
    btVector3 place();
    btTransform pose(double size);
    btSoftBody* anySoft();
    btRigidBody* anyRigid();
    btSoftBody::Node& anyNode(btSoftBody& body);
    int nodeOf(const btSoftBody& body);
    btScalar badNumber();
    void addSoft(btSoftBody* body);
    void forgetJoints();
    void remove(btSoftBody* body);
    void remove(btRigidBody* body);
    void removeRejected();
    void removeLost(const btSoftBody& rejected);

    void step();
    void addBox();
    void addBall();
    void addTets();
    void removeSoft();
    void readd();
    void addRigid();
    void addStatic();
    void removeRigid();
    void throwRigid();
    void setMaterial();
    void setDetail();
    void setFlags();
    void setConfig();
    void writeNodes();
    void writeBadNodes();
    void pin();
    void setMasses();
    void setTargets();
    void clearTargets();
    void anchor();
    void attach();
    void detach();
    void spring();
    void move();
    void scale();
    void remember();
    void append();
    void removeTets();
    void prepare();
    void refactor();
    void save();
    void restore();
    void define();
    void redefine();
    void query();
    void setGravity();
    void makeClusters();
    void setPose();
    void setActivation();
    void replay();
    std::vector<int> pairOrder();

    const unsigned m_number;
    const Manner m_manner;
    std::mt19937 m_generator;
    FemWorld m_world;
    btFemSoftBodySolver& m_fem;
    std::vector<btSoftBody*> m_soft;
    std::vector<btRigidBody*> m_rigid;
    std::vector<int> m_attachments, m_springs;
    std::vector<unsigned char> m_state, m_definition;
    const char* m_last = "";
    int m_refusals = 0;
    long m_steps = 0;
    double m_step = 0;  // length of the last step [s]
    bool m_replayed = true;
};

}  // namespace bullet_fem

// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <Eigen/SparseCholesky>
#include <functional>
#include <string>
#include <vector>

#include "bullet_fem/fem/body/body.h"
#include "bullet_fem/fem/mesh/generators.h"
#include "bullet_fem/fem/step/stepping.h"

namespace bullet_fem
{

/// Chooses nodes by their rest position [m].
using NodePredicate = std::function<bool(const Vec3& X)>;

/// A material of the given E [Pa], nu [-] and rho [kg/m3] without damping.
Material elasticMaterial(double young, double poisson, double density = 1000);

/// A body with lumped masses by `materials`; the chosen nodes are fixed (none by default); step [s] is that of its
/// factor.
Body makeBody(const TetMesh& mesh, const ElementMaterials& materials, const NodePredicate& fixed = {},
              double step = 1.0 / 60);

/// Loads every node with its mass times g [m/s2].
void setGravity(Body& body, const Vec3& g);

/// Per node, a third of the area of the boundary triangles whose three nodes are all chosen [m2].
std::vector<double> faceAreas(const TetMesh& mesh, const NodePredicate& onFace);

/// The node nearest to a rest position [m].
int nodeAt(const TetMesh& mesh, const Vec3& X);

/// Maximum distance of corresponding positions [m].
double largestDistance(const std::vector<Vec3>& a, const std::vector<Vec3>& b);

/// Sum over nodes of weight_i u_i, divided by the sum of the weights.
Vec3 weightedMean(const std::vector<double>& weights, const std::vector<Vec3>& u);

/// The rotation by `angle` [rad] about `axis` (any length but zero).
Mat3 rotationAbout(const Vec3& axis, double angle);

/// Random vectors with components in [-1, 1], in a sequence that is equal on all machines.
class RandomVectors
{
public:
    explicit RandomVectors(unsigned seed) : m_state(seed) {}
    Vec3 next() { return {number(), number(), number()}; }

private:
    double number();
    unsigned long long m_state;
};

/// Kinetic energy [J].
double kineticEnergy(const BodyState& state);

/// Smallest element volume over its rest volume [-]; negative where an element is inverted.
double smallestVolumeRatio(const Body& body);

/// Quasi-static equilibrium under the body's loads, by steps of its model's h that start from rest each time. 1 / h
/// must be far below each frequency of the body, so that a step is one Newton iteration. Returns the maximum node
/// displacement of the last step [m], at or below `tolerance` if that is reached within 400 steps.
double relax(Body& body, double tolerance);

/// An eigenmode of K phi = omega^2 M phi, phi^T M phi = 1.
struct Mode
{
    double m_omega = 0;         ///< [rad/s]
    std::vector<Vec3> m_shape;  ///< phi, one a node [kg^-1/2]
};

/// The rotations of a body's elements at its positions, in double precision.
std::vector<Mat3> elementRotations(const Body& body);

/// The assembled rest stiffness K and the lumped mass of a shape with clamped nodes: linear statics and vibrations by
/// Eigen's factorization, independent of the stepping code.
class LinearSystem
{
public:
    LinearSystem(const RestShape& shape, const NodePredicate& clamped);

    /// u with K u = force [N] on the free nodes, 0 on the clamped ones [m].
    std::vector<Vec3> displacement(const std::vector<Vec3>& force) const;

    /// The `count` lowest modes in ascending order, by subspace iteration.
    std::vector<Mode> lowestModes(int count) const;

private:
    Eigen::VectorXd gather(const std::vector<Vec3>& u) const;
    std::vector<Vec3> scatter(const Eigen::VectorXd& u) const;

    std::vector<int> m_position;  // per node, its block row among the free ones; -1 where clamped
    Eigen::VectorXd m_mass;       // per free degree of freedom
    Eigen::SparseMatrix<double> m_stiffness;
    Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> m_factor;
};

}  // namespace bullet_fem

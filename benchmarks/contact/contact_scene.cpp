// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "benchmarks/contact/contact_scene.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "bullet_fem/fem/mesh/generators.h"

namespace bullet_fem
{
namespace
{

constexpr double kCell = 0.05;   // side of the cells of blocks and slabs [m]
constexpr double kDrop = 0.005;  // height of their fall before contact [m]
constexpr int kTetsPerCell = 5;
constexpr double kColumnStiffness = 5e5;  // E [Pa]: foam would buckle under its own weight
constexpr int kCrushed = 15;              // lower nodes per node in contact above which a cube would be crushed

/// Upholstery foam. Bullet's deformable contact diverges with stiffer or denser materials at these cells and steps: the
/// effective masses of its contacts grow with the square of the elastic forces.
Material sceneMaterial()
{
    Material material = Material::foam();
    material.m_stiffnessDamping = 0.01;
    return material;
}

/// Cells of a block and size of the rectangle of its lower nodes in contact.
struct BlockPlan
{
    std::array<int, 3> m_cells;
    std::array<int, 2> m_touching;
};

BlockPlan planBlock(int contacts, int tets)
{
    BlockPlan plan;
    const double cells = double(tets) / kTetsPerCell;
    const int p = std::max(2, static_cast<int>(std::sqrt(double(contacts))));
    plan.m_touching = {p, std::max(2, static_cast<int>(std::lround(double(contacts) / p)))};
    const int side = std::max(1, static_cast<int>(std::lround(std::cbrt(cells))));
    const int nx = std::max(side, plan.m_touching[0] - 1), ny = std::max(side, plan.m_touching[1] - 1);
    plan.m_cells = {nx, ny, static_cast<int>(std::lround(cells / (double(nx) * ny)))};
    return plan;
}

/// Nodes at the mesh's minimum z.
std::vector<int> lowestNodes(const TetMesh& mesh)
{
    double lowest = HUGE_VAL;
    for (const Vec3& X : mesh.restPositions()) lowest = std::min(lowest, X.z);
    std::vector<int> nodes;
    for (int i = 0; i < mesh.nodeCount(); ++i)
        if (mesh.restPositions()[i].z < lowest + 1e-9) nodes.push_back(i);
    return nodes;
}

double massOf(const ContactScene& scene, const SoftPart& part)
{
    return scene.m_material.m_density * part.m_mesh.volume();
}

}  // namespace

int ContactScene::tetCount() const
{
    int count = 0;
    for (const SoftPart& part : m_soft) count += part.m_mesh.tetCount();
    return count;
}

int ContactScene::nodeCount() const
{
    int count = 0;
    for (const SoftPart& part : m_soft) count += part.m_mesh.nodeCount();
    return count;
}

bool ContactScene::isFree() const
{
    bool free = norm(m_gravity) == 0;
    for (const SoftPart& part : m_soft) free = free && part.m_pinned.empty();
    for (const BoxPart& box : m_boxes) free = free && box.m_mass > 0;
    return free;
}

bool hasBlock(int contacts, int tets)
{
    if (contacts < 4 || tets < kTetsPerCell) return false;
    const BlockPlan plan = planBlock(contacts, tets);
    const auto [nx, ny, nz] = plan.m_cells;
    const bool ofThatSize = std::abs(double(kTetsPerCell) * nx * ny * nz / tets - 1) < 0.25;
    return ofThatSize && kCrushed * plan.m_touching[0] * plan.m_touching[1] >= (nx + 1) * (ny + 1);
}

ContactScene blockOnBox(int contacts, int tets)
{
    if (!hasBlock(contacts, tets))
        throw std::invalid_argument(
            "no block of " + std::to_string(tets) + " tets can rest on " + std::to_string(contacts) +
            " nodes; contacts must be at least 4, at least a fifteenth of a cube's lower nodes, and at most those of a "
            "plate of one layer");
    const BlockPlan plan = planBlock(contacts, tets);
    const auto [nx, ny, nz] = plan.m_cells;

    ContactScene scene;
    scene.m_name = "block on static box";
    scene.m_material = sceneMaterial();
    scene.m_cellSize = kCell;
    const Vec3 size = kCell * Vec3{double(nx), double(ny), double(nz)};
    scene.m_size = std::max({size.x, size.y, size.z});
    scene.m_soft.push_back({makeBox(size, plan.m_cells, {0, 0, kDrop}), {}, {}});

    // the box extends a quarter of a cell beyond the nodes that it supports
    BoxPart box;
    const double height = 0.5;
    const Vec3 first = {double((nx + 1 - plan.m_touching[0]) / 2), double((ny + 1 - plan.m_touching[1]) / 2), 0};
    const Vec3 span = {double(plan.m_touching[0] - 1), double(plan.m_touching[1] - 1), 0};
    box.m_center = kCell * (first + 0.5 * span) + Vec3{0, 0, -height / 2};
    box.m_halfExtents = kCell * (0.5 * span + Vec3{0.25, 0.25, 0}) + Vec3{0, 0, height / 2};
    scene.m_boxes.push_back(box);
    return scene;
}

ContactScene columnOnBox(int contacts, int tets, bool pinned)
{
    const int n = std::max(1, static_cast<int>(std::lround(std::sqrt(double(contacts)))) - 1);
    const int layers = std::max(1, static_cast<int>(std::lround(double(tets) / (kTetsPerCell * n * n))));
    const double side = n * kCell, height = layers * kCell;
    ContactScene scene;
    scene.m_name = "column on its foot";
    scene.m_material = sceneMaterial();
    scene.m_material.m_youngModulus = kColumnStiffness;
    scene.m_steps = 180;
    scene.m_cellSize = kCell;
    scene.m_size = height;
    const TetMesh mesh = makeBox({side, side, height}, {n, n, layers}, {-side / 2, -side / 2, 0});
    scene.m_soft.push_back({mesh, pinned ? lowestNodes(mesh) : std::vector<int>(), {}});
    if (!pinned) scene.m_boxes.push_back({{0, 0, -0.5}, {side, side, 0.5}, 0, {}});
    return scene;
}

ContactScene ballAndCube(double massRatio, int cells)
{
    ContactScene scene;
    scene.m_name = "ball meets cube, zero gravity";
    scene.m_material = sceneMaterial();
    scene.m_gravity = {};
    scene.m_steps = 60;
    scene.m_cellSize = 1.0 / cells;
    scene.m_soft.push_back({makeSphere(0.5, cells), {}, {}});

    BoxPart cube;
    cube.m_center = {0.23, -0.11, 0.8};
    cube.m_halfExtents = {0.25, 0.25, 0.25};
    cube.m_mass = massRatio * massOf(scene, scene.m_soft[0]);
    cube.m_velocity = {0, 0, -1};
    scene.m_boxes.push_back(cube);
    return scene;
}

ContactScene slabOnSlab(int contacts)
{
    const int n = std::max(1, static_cast<int>(std::lround(std::sqrt(double(contacts)))) - 1);
    const double side = n * kCell, height = 2 * kCell;
    ContactScene scene;
    scene.m_name = "soft slab on soft slab";
    scene.m_material = sceneMaterial();
    scene.m_cellSize = kCell;
    scene.m_size = side;
    const TetMesh lower = makeBox({side, side, height}, {n, n, 2}, {0, 0, -height});
    scene.m_soft.push_back({lower, lowestNodes(lower), {}});
    scene.m_soft.push_back({makeBox({side, side, height}, {n, n, 2}, {0.3 * kCell, 0.2 * kCell, kDrop}), {}, {}});
    return scene;
}

ContactScene rigidOnSoftStack(int cells)
{
    const double side = 0.2, height = 0.1, gap = 1e-3, massRatio = 50;
    ContactScene scene;
    scene.m_name = "stack: floor, soft, rigid, soft, rigid";
    scene.m_material = sceneMaterial();
    scene.m_steps = 120;
    scene.m_size = side;
    scene.m_cellSize = side / cells;
    scene.m_boxes.push_back({{0, 0, -0.5}, {1, 1, 0.5}, 0, {}});
    double z = 0;
    for (int k = 0; k < 2; ++k)
    {
        const Vec3 corner = {-side / 2, -side / 2, z + gap};
        scene.m_soft.push_back({makeBox({side, side, height}, {cells, cells, std::max(1, cells / 2)}, corner), {}, {}});
        z += gap + height;
        const double mass = massRatio * massOf(scene, scene.m_soft.back());
        scene.m_boxes.push_back({{0, 0, z + gap + height / 2}, {0.6 * side, 0.6 * side, height / 2}, mass, {}});
        z += gap + height;
    }
    return scene;
}

}  // namespace bullet_fem

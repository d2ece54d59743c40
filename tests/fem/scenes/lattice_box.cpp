// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "fem/scenes/lattice_box.h"

#include <algorithm>
#include <map>
#include <utility>

#include "fem/scenes/elasticity_scenes.h"

namespace bullet_fem
{

TetMesh makeLatticeBox(const std::array<int, 3>& cells, double cell)
{
    std::map<std::array<int, 3>, int> nodes;  // by twice their coordinates
    std::vector<Vec3> X;
    const auto node = [&](const std::array<int, 3>& place)
    {
        const auto [at, isNew] = nodes.try_emplace(place, static_cast<int>(X.size()));
        if (isNew) X.push_back(0.5 * cell * Vec3{1.0 * place[0], 1.0 * place[1], 1.0 * place[2]});
        return at->second;
    };
    std::vector<Tet> tets;
    for (int z = 0; z < cells[2]; ++z)
        for (int y = 0; y < cells[1]; ++y)
            for (int x = 0; x < cells[0]; ++x)
                for (int axis = 0; axis < 3; ++axis)
                    for (const int side : {-1, 1})
                    {
                        const std::array<int, 3> cube = {x, y, z}, middle = {2 * x + 1, 2 * y + 1, 2 * z + 1};
                        const bool onBoundary = side < 0 ? cube[axis] == 0 : cube[axis] == cells[axis] - 1;
                        if (side > 0 && !onBoundary) continue;  // belongs to the next cube
                        std::array<int, 3> other = middle;
                        other[axis] += onBoundary ? side : 2 * side;
                        const int b = (axis + 1) % 3, c = (axis + 2) % 3;
                        constexpr int kRing[5][2] = {{-1, -1}, {1, -1}, {1, 1}, {-1, 1}, {-1, -1}};
                        for (int k = 0; k < 4; ++k)
                        {
                            std::array<int, 3> p = middle, q = middle;
                            p[axis] += side, p[b] += kRing[k][0], p[c] += kRing[k][1];
                            q[axis] += side, q[b] += kRing[k + 1][0], q[c] += kRing[k + 1][1];
                            tets.push_back({node(middle), node(other), node(p), node(q)});
                        }
                    }
    return TetMesh(std::move(X), std::move(tets));
}

TetMesh shuffledMesh(const TetMesh& mesh, double share, unsigned seed)
{
    std::vector<Vec3> X = mesh.restPositions();
    std::vector<unsigned char> onSurface(X.size());
    for (const int node : mesh.surfaceNodes()) onSurface[node] = 1;
    RandomVectors random(seed);
    for (std::size_t i = 0; i < X.size(); ++i)
    {
        const Vec3 r = random.next();
        if (!onSurface[i]) X[i] += share * mesh.meanEdgeLength() * r;
    }
    std::vector<std::pair<double, Tet>> order;
    for (const Tet& t : mesh.tets()) order.push_back({random.next().x, {t[1], t[2], t[0], t[3]}});
    std::sort(order.begin(), order.end());
    std::vector<Tet> tets;
    for (const auto& [key, tet] : order) tets.push_back(tet);
    return TetMesh(std::move(X), std::move(tets));
}

}  // namespace bullet_fem

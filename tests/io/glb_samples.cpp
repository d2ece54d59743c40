// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// Writes films with all settings into the given folder, for the validator.
#include <cstdio>
#include <string>

#include "bullet_fem/io/glb_film.h"
#include "io/sample_bodies.h"

using namespace bullet_fem;

namespace
{

void writeFilms(const std::string& folder, int colours, bool normals)
{
    GlbSettings settings;
    settings.m_colours = static_cast<GlbColours>(colours);
    settings.m_normals = settings.m_stepped = settings.m_zUp = normals;
    GlbFilm film(settings);
    const std::string name = folder + "/colours" + std::to_string(colours) + (normals ? "normals" : "");
    for (int k = 0; k < 5; ++k)
    {
        BodyFrame triangle = sampleTriangle(7);  // k = 3: without area
        for (Vec3& x : triangle.m_positions) x.y *= k == 3 ? 0 : 1;
        triangle.m_nodeStress.resize(3);
        film.addFrame(1 + 0.1 * k, {sampleBox(0, 0.1 * k), triangle, sampleBox(2, 0.3 * k)});
        if (k == 0) film.write(name + "_still.glb");
    }
    film.write(name + ".glb");
}

}  // namespace

int main(int argc, char** argv)
{
    if (argc != 2) return 2;
    for (int colours = 0; colours < 3; ++colours)
        for (const bool normals : {false, true}) writeFilms(argv[1], colours, normals);
    return 0;
}

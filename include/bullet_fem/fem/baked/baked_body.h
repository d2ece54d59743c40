// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "bullet_fem/fem/cage/cage.h"
#include "bullet_fem/fem/common/export.h"
#include "bullet_fem/fem/factor/body_model.h"

namespace bullet_fem
{

/// A body that was made ready off line: what a .bfem file holds. Reading one takes milliseconds, and neither orders nor
/// factors. docs/baked.md has the format and what is promised.
struct BakedBody
{
    std::vector<Vec3> m_positions;       ///< of the nodes at rest [m]; the model's mesh has node 0 at the origin
    std::vector<double> m_inverseMass;   ///< of the nodes, of pinned ones too [1/kg], > 0
    std::vector<double> m_filled;        ///< fraction of every element, in (0, 1]; empty if all are 1
    double m_massScale = 1;              ///< of a cage, factor on all masses [-], > 0; the masses have it
    std::vector<Embedding> m_embedding;  ///< per vertex of the surface that follows the body; empty if there is none
    std::vector<Triangle> m_triangles;   ///< of that surface
    bool m_surfaceCollides = false;      ///< that surface collides, not the boundary of the elements
    bool m_singlePrecision = true;       ///< numbers are rounded to what Bullet in single precision holds of them
    std::shared_ptr<const BodyModel> m_model;  ///< mesh, material, masses, pins, step and factor; never null
};

/// What a body is baked for.
struct BakeSettings
{
    Material m_material;  ///< a density of 0 is taken for water's, 1000 kg/m3
    /// Per element the label of its region, and the regions' materials, in place of m_material; empty: it is of all.
    std::vector<int> m_labels;
    std::map<int, Material> m_regionMaterials;  ///< by label
    double m_step = 1.0 / 60;                   ///< the fixed step of the world [s], in [1e-6, 1]
    std::vector<int> m_pins;                    ///< nodes that are pinned, each in [0, n)
    /// The precision of the Bullet that will move the body: numbers are rounded as its nodes and materials hold them,
    /// and the body moves bit for bit like one that was not baked. Read by the other one, it differs by rounding.
    bool m_singlePrecision = true;
    FactorChoice m_choice = FactorChoice::full;  ///< which factor it gets
    std::size_t m_maxBytes = 0;                  ///< memory that the factor may take [B], 0 for any amount
};

/// Functions with a last argument `why` throw if that is null. Else, for engines without exceptions, they return false,
/// a body without model or an info without nodes where they would throw, with the reason in `why`.

/// Makes a body of a mesh ready, or of a cage with the surface that it was made of. Throws std::invalid_argument,
/// naming the value, on bad settings or a mesh that rounding spoils, and what BodyModel::create throws.
BULLETFEM_API BakedBody bakeBody(const TetMesh& mesh, const BakeSettings& settings, std::string* why = nullptr);
/// The same of a cage and its surface.
BULLETFEM_API BakedBody bakeBody(const Cage& cage, const SurfaceMesh& surface, const BakeSettings& settings,
                                 std::string* why = nullptr);

/// Writes it to a file, under a temporary name beside it at first, so that there is either the whole file or what was
/// there before. The same body gives the same bytes. Throws std::runtime_error that names the file, what went wrong and
/// what to do.
BULLETFEM_API bool writeBakedBody(const std::string& path, const BakedBody& body, std::string* why = nullptr);

/// How a file gets into memory.
enum class BakedLoading
{
    /// Mapped: the factor stays in the file, its pages are shared by all programs that have it, and count as cache. The
    /// file must not be changed while a body uses it, or the program may crash; replacing it, as writeBakedBody does,
    /// is no change. Where there is no mmap: copied.
    mapped,
    copied  ///< read at once; the file is not needed any more
};

/// Reads one. Every byte is checked, and all that is an index: nothing in a file can make the program crash. Throws
/// std::runtime_error that names the file, what is wrong with it and what to do: it is missing, cut off, damaged, not a
/// baked body, of another byte order, of an older or newer version, or its numbers do not make a body.
BULLETFEM_API BakedBody readBakedBody(const std::string& path, BakedLoading loading = BakedLoading::mapped,
                                      std::string* why = nullptr);

/// The same for a file that lies in memory already, as those of an archive do; it is copied. `name` is for messages.
BULLETFEM_API BakedBody readBakedBody(const unsigned char* data, std::size_t size, const std::string& name,
                                      std::string* why = nullptr);

/// What stands at the beginning of a file.
struct BakedFileInfo
{
    int m_version = 0;                ///< of the format
    std::uint64_t m_fileBytes = 0;    ///< [B]
    std::uint64_t m_factorBytes = 0;  ///< of them the factor's panels [B]
    int m_nodes = 0;                  ///< of the mesh
    int m_tets = 0;                   ///< likewise
    int m_freeNodes = 0;              ///< that are neither pinned nor loose
    int m_embeddedVertices = 0;       ///< 0: there is no embedded surface
    int m_embeddedTriangles = 0;      ///< of that surface
    bool m_surfaceCollides = false;   ///< the embedded surface does, not the boundary
    Material m_material;              ///< that the body was baked with; of the first region, if there are several
    int m_regions = 1;                ///< of different materials: the model has them, see RestShape::m_materials
    double m_step = 0;                ///< that the factor was made for [s]
    bool m_singlePrecision = true;    ///< see BakeSettings
    FactorReport m_factor;            ///< as it was reported when the body was baked, without the time that it took
};

/// Reads the beginning alone, and whether the file is as long as it must be. Throws like readBakedBody.
BULLETFEM_API BakedFileInfo inspectBakedBody(const std::string& path, std::string* why = nullptr);

}  // namespace bullet_fem

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

/// A body prepared off line, the contents of a .bfem file. Reading one takes milliseconds, without ordering or
/// factorization. docs/baked.md specifies the format and its compatibility.
struct BakedBody
{
    std::vector<Vec3> m_positions;       ///< rest positions of the nodes [m]; the model's mesh has node 0 at the origin
    std::vector<double> m_inverseMass;   ///< inverse masses of the nodes, pinned ones included [1/kg], > 0
    std::vector<double> m_filled;        ///< filled fraction of every element [-], in (0, 1]; empty if all are 1
    double m_massScale = 1;              ///< factor on all masses of a cage [-], > 0; m_inverseMass includes it
    std::vector<Embedding> m_embedding;  ///< per vertex of the embedded surface; empty if there is none
    std::vector<Triangle> m_triangles;   ///< triangles of the embedded surface
    bool m_surfaceCollides = false;      ///< the embedded surface collides, instead of the elements' boundary
    bool m_singlePrecision = true;       ///< values are rounded to single precision, as Bullet stores them
    std::shared_ptr<const BodyModel> m_model;  ///< mesh, material, masses, pins, step and factor; never null
};

/// The inputs of bakeBody().
struct BakeSettings
{
    Material m_material;  ///< a density of 0 is replaced by water's, 1000 kg/m3
    /// Per element the label of its region; m_regionMaterials then replaces m_material. Empty: m_material everywhere.
    std::vector<int> m_labels;
    std::map<int, Material> m_regionMaterials;  ///< material of each label
    double m_step = 1.0 / 60;                   ///< the fixed step of the world [s], in [1e-6, 1]
    std::vector<int> m_pins;                    ///< pinned nodes, each in [0, n)
    /// Precision of the Bullet build that will move the body: values are rounded as its nodes and materials store them,
    /// and the body moves bit for bit as one that was not baked. In the other precision it differs by rounding.
    bool m_singlePrecision = true;
    FactorChoice m_choice = FactorChoice::full;  ///< which factor to build
    std::size_t m_maxBytes = 0;                  ///< maximum memory of the factor [B]; 0: unlimited
};

/// Functions with a last argument `why` throw if it is null. Otherwise, for engines without exceptions, they do not
/// throw: they write the reason to `why` and return false, a body without model, or an info without nodes.

/// Bakes a body of a mesh. Throws std::invalid_argument, naming the value, on bad settings or a mesh that rounding
/// makes invalid; std::runtime_error if A0 cannot be factored or the factor would exceed settings.m_maxBytes.
/// Allocates.
BULLETFEM_API BakedBody bakeBody(const TetMesh& mesh, const BakeSettings& settings, std::string* why = nullptr);
/// Bakes a body of a cage and the surface that it was made of. Throws std::invalid_argument, naming the value, on bad
/// settings or a mesh that rounding makes invalid; std::runtime_error if A0 cannot be factored or the factor would
/// exceed settings.m_maxBytes. Allocates.
BULLETFEM_API BakedBody bakeBody(const Cage& cage, const SurfaceMesh& surface, const BakeSettings& settings,
                                 std::string* why = nullptr);

/// Writes a body to a file, first under a temporary name in its directory, so that the path holds either the whole new
/// file or the previous one. Equal bodies give equal bytes. Throws std::runtime_error naming file, reason and remedy.
BULLETFEM_API bool writeBakedBody(const std::string& path, const BakedBody& body, std::string* why = nullptr);

/// Loading of a file into memory.
enum class BakedLoading
{
    /// Memory-mapped: the factor stays in the file, and its pages are shared by all programs and count as cache.
    /// Changing the file in place while a body uses it may crash the program; replacing it, as writeBakedBody does, is
    /// safe. Copied where there is no mmap.
    mapped,
    copied  ///< read completely; the file is not used afterwards
};

/// Reads a baked body. Every byte and every index is checked: no file contents can crash the program. Throws
/// std::runtime_error naming file, reason and remedy: the file is missing, truncated, damaged, not a baked body, of
/// another byte order, of an older or newer version, or its values do not form a body. Allocates.
BULLETFEM_API BakedBody readBakedBody(const std::string& path, BakedLoading loading = BakedLoading::mapped,
                                      std::string* why = nullptr);

/// Reads a baked body from memory, for instance from an archive, with all checks of the other overload; copies the
/// data. `data` has `size` bytes [B]; `name` stands in messages. Throws std::runtime_error naming `name`, reason and
/// remedy. Allocates.
BULLETFEM_API BakedBody readBakedBody(const unsigned char* data, std::size_t size, const std::string& name,
                                      std::string* why = nullptr);

/// The header of a baked file.
struct BakedFileInfo
{
    int m_version = 0;                ///< version of the format
    std::uint64_t m_fileBytes = 0;    ///< size of the file [B]
    std::uint64_t m_factorBytes = 0;  ///< size of the factor's panels within it [B]
    int m_nodes = 0;                  ///< number of nodes of the mesh
    int m_tets = 0;                   ///< number of elements of the mesh
    int m_freeNodes = 0;              ///< number of nodes that are neither pinned nor loose
    int m_embeddedVertices = 0;       ///< 0: there is no embedded surface
    int m_embeddedTriangles = 0;      ///< number of triangles of the embedded surface
    bool m_surfaceCollides = false;   ///< the embedded surface collides, not the boundary
    Material m_material;              ///< material; that of the first region, if there are several
    int m_regions = 1;                ///< number of regions; RestShape::m_materials of the model has them
    double m_step = 0;                ///< step of the factor [s]
    bool m_singlePrecision = true;    ///< as BakeSettings::m_singlePrecision
    FactorReport m_factor;            ///< report of the factorization, without its time
};

/// Reads the header only, and checks the length of the file. Throws std::runtime_error naming file, reason and remedy,
/// as readBakedBody does.
BULLETFEM_API BakedFileInfo inspectBakedBody(const std::string& path, std::string* why = nullptr);

}  // namespace bullet_fem

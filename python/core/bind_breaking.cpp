// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include <limits>

#include "bullet_fem/btFemFracture.h"
#include "bullet_fem/btFemWelds.h"
#include "python/core/handles.h"
#include "python/core/soft_maker.h"

namespace bullet_fem::python
{
namespace
{

constexpr double kInfinite = std::numeric_limits<double>::infinity();
constexpr double kSmallest = 1e-300;

btFemWeldStrength strengthOf(py::handle force, py::handle stress, py::handle stretch, py::handle compliance)
{
    btFemWeldStrength strength;
    strength.m_breakForce = numberOf(force, "break_force", kSmallest, kInfinite);
    strength.m_breakStress = numberOf(stress, "break_stress", kSmallest, kInfinite);
    strength.m_breakStretch = numberOf(stretch, "break_stretch", kSmallest, kInfinite);
    strength.m_compliance = numberOf(compliance, "compliance", 0, 1);
    return strength;
}

int weld(const SoftHandle& self, const SoftHandle& other, py::handle force, py::handle stress, py::handle stretch,
         py::handle compliance, py::handle reach)
{
    self.mustShareWorld(other, "other");
    return btFemWelds::weld(self.fem(), self.changing().m_body, other.changing().m_body,
                            strengthOf(force, stress, stretch, compliance), numberOf(reach, "reach", 0, 1e3));
}

py::list weldsOf(const SoftHandle& self)
{
    btAlignedObjectArray<btFemWeldReport> reports;
    btFemWelds::welds(self.fem(), &self.body(), reports);
    py::list list;
    for (int i = 0; i < reports.size(); ++i)
    {
        const btFemWeldReport& from = reports[i];
        py::dict report;
        report["handle"] = from.m_weld;
        report["other"] = self.world().bodies().indexOf(from.m_b);
        report["nodes"] = from.m_nodes;
        report["area"] = from.m_area;
        report["force"] = arrayOf(from.m_force);
        report["stress"] = from.m_stress;
        report["stretch"] = from.m_stretch;
        list.append(report);
    }
    return list;
}

py::list breaksOf(World& world)
{
    world.guard().reading();
    const auto& breaks = btFemWelds::breaks(world.fem());
    py::list list;
    for (int i = 0; i < breaks.size(); ++i)
    {
        const btFemWeldBreak& from = breaks[i];
        py::dict report;
        report["handle"] = from.m_weld;
        report["body"] = world.bodies().indexOf(from.m_a);
        report["other"] = world.bodies().indexOf(from.m_b);
        report["broken"] = from.m_broken;
        report["left"] = from.m_left;
        report["force"] = arrayOf(from.m_force);
        report["stress"] = from.m_stress;
        report["time"] = from.m_time;
        list.append(report);
    }
    return list;
}

using Parts = std::vector<std::unique_ptr<SoftEntry>>;

/// The parts of a body with their materials. Throws without a trace of them.
Parts partsOf(World& world, const SoftEntry& whole, const std::vector<int>& labels, const ElementMaterials& materials)
{
    std::vector<btFemPiece> pieces;
    btFemPieces::cut(whole.m_body, labels, pieces);
    Parts parts;
    for (const btFemPiece& piece : pieces)
    {
        parts.push_back(std::make_unique<SoftEntry>());
        parts.back()->m_own.reset(piece.m_body);
        parts.back()->m_body = piece.m_body;
        parts.back()->m_turn = whole.m_turn;
    }
    try
    {
        for (const auto& part : parts) setMaterials(world, *part, materials);
    }
    catch (...)
    {
        for (const auto& part : parts) world.fem().forget(part->m_body);
        throw;
    }
    return parts;
}

/// Adds the parts; those that cannot be added are dropped, and the last exception is thrown.
py::list addParts(const WorldPointer& world, Parts parts, const std::string& name, int group, int mask)
{
    py::list list;
    std::exception_ptr thrown;
    for (std::size_t i = 0; i < parts.size(); ++i)
    {
        try
        {
            const int index = world->add(std::move(parts[i]), name + "." + std::to_string(i), group, mask);
            list.append(py::cast(SoftHandle{{world, index}}));
        }
        catch (...)
        {
            world->fem().forget(parts[i]->m_body);
            thrown = std::current_exception();
        }
    }
    if (thrown) std::rethrow_exception(thrown);
    return list;
}

/// Replaces a body by bodies of its labels.
py::list cut(const SoftHandle& self, py::handle labels, const Material& material)
{
    const SoftEntry& entry = self.changing();
    World& world = self.world();
    if (!entry.m_own) throw py::value_error("bodies of a scene cannot be cut");
    if (entry.m_views > 0)
        throw std::runtime_error("a view of the body's nodes exists: delete the array before the body is cut");
    ElementMaterials materials;
    materials.m_base = material;
    Parts parts = partsOf(world, entry, labelsOf(labels, "labels"), materials);
    const std::string name = world.bodies()[self.m_index].m_name;
    const btBroadphaseProxy* proxy = entry.m_body->getBroadphaseHandle();
    const int group = proxy->m_collisionFilterGroup, mask = proxy->m_collisionFilterMask;
    world.removeBody(self.m_index);
    return addParts(self.m_world, std::move(parts), name, group, mask);
}

py::array_t<int> voronoiLabels(const SoftHandle& self, int cells, int seed)
{
    std::vector<int> labels;
    btFemPieces::voronoiLabels(&self.body(), cells, unsigned(seed), labels);
    return arrayOf(labels);
}

void setStrength(const SoftHandle& self, py::handle tension, int maxCracks, bool partsCollide)
{
    SoftEntry& entry = self.changing();
    if (entry.m_views > 0)
        throw std::runtime_error(
            "a view of the body's nodes exists, and these move in memory when it splits: delete the array before");
    btFemTensileStrength strength;
    strength.m_tension = numberOf(tension, "tension", kSmallest, 1e13);
    strength.m_mostCracks = maxCracks;
    strength.m_partsTouch = partsCollide;
    btFemFracture::setStrength(self.fem(), entry.m_body, strength);
    entry.m_mayBreak = true;
}

py::list splitsOf(World& world)
{
    world.guard().reading();
    const auto& splits = btFemFracture::splits(world.fem());
    py::list list;
    for (int i = 0; i < splits.size(); ++i)
    {
        const btFemSplit& from = splits[i];
        py::dict report;
        report["body"] = world.bodies().indexOf(from.m_body);
        report["cracks"] = from.m_cracks;
        report["area"] = from.m_area;
        report["place"] = arrayOf(from.m_place);
        report["normal"] = arrayOf(from.m_normal);
        report["stress"] = from.m_stress;
        report["parts"] = from.m_parts;
        report["copy_of"] = arrayOf(from.m_copyOf);
        report["time"] = from.m_time;
        list.append(report);
    }
    return list;
}

}  // namespace

void bindBreaking(SoftClass& body, WorldClass& world)
{
    body.def("weld", &weld, py::arg("other"), py::kw_only(), py::arg("break_force") = kInfinite,
             py::arg("break_stress") = kInfinite, py::arg("break_stretch") = kInfinite, py::arg("compliance") = 0,
             py::arg("reach") = 0,
             "Welds another body at common faces, whose corners are at most `reach` [m] apart, until the force [N], a "
             "stress\n"
             "[Pa] or a stretch [m] is larger; compliance of the glue [m/Pa]. Returns a handle of this body.")
        .def_property_readonly(
            "welds", &weldsOf,
            "Welds that this body owns, a list of dicts: handle, other (index), nodes, area [m2], force [N],\n"
            "stress [Pa], stretch [m].")
        .def("voronoi_labels", &voronoiLabels, py::arg("cells"), py::arg("seed") = 1,
             "A label for each element, int32 (m,): the nearest of `cells` random points.")
        .def("cut", &cut, py::arg("labels"), py::arg("material"),
             "Replaces the body by bodies of the elements of each label, integers (m,), and returns them.")
        .def("set_strength", &setStrength, py::arg("tension"), py::arg("max_cracks") = 1,
             py::arg("parts_collide") = true,
             "Lets the body split along faces where the tension exceeds its strength [Pa]. Views of its nodes are "
             "refused.");
    world
        .def_property_readonly(
            "weld_breaks", &breaksOf,
            "Broken welds so far, a list of dicts: handle, body and other (indices), broken and left\n"
            "(nodes), force [N], stress [Pa], time [s].")
        .def_property_readonly(
            "splits", &splitsOf,
            "Splits so far, a list of dicts: body (index), cracks, area [m2], place [m], normal [-], stress\n"
            "[Pa], parts, copy_of (the node that each new node was copied from), time [s].");
}

}  // namespace bullet_fem::python

// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "bullet_fem/btFemFlagText.h"

#include <algorithm>
#include <iterator>

#include "bullet_fem/btFemReports.h"

namespace
{

constexpr btFemFlagText kFlagTexts[] = {
    {BT_FEM_NOT_CONVERGED, "BT_FEM_NOT_CONVERGED", "not converged",
     "A solve stopped at its iteration limit, short of its tolerance. The result is usable; take smaller steps, raise "
     "the limit, or call refactor()."},
    {BT_FEM_BREAKDOWN, "BT_FEM_BREAKDOWN", "solve broke down",
     "The system of equations was singular to rounding, and the best iterate was kept. Check masses and Young's "
     "modulus: neighbouring values must not be powers of ten apart."},
    {BT_FEM_STALE_FACTOR, "BT_FEM_STALE_FACTOR", "factor out of date",
     "The factor was made for another step, other masses or other pins, which costs iterations. Call refactor()."},
    {BT_FEM_RESTORED, "BT_FEM_RESTORED", "values put back",
     "A position, velocity or force was not a number, or a position or velocity was beyond 1e6 m or m/s. It was put "
     "back or dropped; find what wrote it, or take smaller steps."},
    {BT_FEM_BAD_MASS, "BT_FEM_BAD_MASS", "bad masses",
     "A node's inverse mass was negative, infinite or not a number, and mass was shared out by volume. Give every node "
     "a mass above 0, or 0 to pin it."},
    {BT_FEM_BAD_STEP, "BT_FEM_BAD_STEP", "bad time step",
     "The time step was not in [1e-6, 1] s, and the body stood still. Step the world by a step in this range."},
    {BT_FEM_REJECTED, "BT_FEM_REJECTED", "not moved by finite elements",
     "The mesh or the material is unusable, and Bullet's springs move the body. Mend what the message names."},
    {BT_FEM_ADDED_TWICE, "BT_FEM_ADDED_TWICE", "added twice",
     "The world holds the body more than once. It is stepped once; remove it once."},
    {BT_FEM_OTHER_WORLD, "BT_FEM_OTHER_WORLD", "in two worlds",
     "The body was added to a second world or solver, which steps it now. Remove it from one of them."},
    {BT_FEM_TURNED_TETS, "BT_FEM_TURNED_TETS", "elements turned",
     "Elements of the mesh had negative orientation and were turned. Nothing needs to be changed."},
    {BT_FEM_SEVERAL_PIECES, "BT_FEM_SEVERAL_PIECES", "in several pieces",
     "The mesh is not connected, and its components move on their own. Join them in the mesh if they belong together."},
    {BT_FEM_UNKNOWN_SHAPE, "BT_FEM_UNKNOWN_SHAPE", "shape without contact",
     "The body overlaps a shape that cannot be asked for contacts, and does not touch it: an empty shape, a distance "
     "field that was not loaded, a mesh without its tree, a hull without points or a class of another kind. Replace "
     "the shape."},
    {BT_FEM_CONTACT_LIMIT, "BT_FEM_CONTACT_LIMIT", "too many contacts",
     "There were more contact points than allowed; they were thinned by place. Take a coarser mesh, or raise "
     "btFemSolverInfo::m_maxContacts."},
    {BT_FEM_REFACTORED, "BT_FEM_REFACTORED", "new factor",
     "The body got a new factor, since its step or masses had changed or the solver was told to make one. The step "
     "with it takes longer; nothing needs to be changed."},
    {BT_FEM_LOST_ANCHOR, "BT_FEM_LOST_ANCHOR", "anchor lost",
     "The other end of an anchor or joint left the world, and the body lost it. Remove the anchor or joint first."},
    {BT_FEM_BAD_ANCHOR, "BT_FEM_BAD_ANCHOR", "anchor ignored",
     "An anchor to a foreign node, or to a soft body without finite elements, was ignored. Anchor nodes of the body to "
     "rigid bodies or to such soft bodies."},
    {BT_FEM_REFACTOR_PAYS, "BT_FEM_REFACTOR_PAYS", "new factor would pay",
     "The factor is out of date and has cost more iterations than a new one costs. Call refactor()."},
    {BT_FEM_BAD_INTEREST, "BT_FEM_BAD_INTEREST", "bad interest",
     "The interest in the body was not in [0, 1]: it was clamped, or taken for 1 if it was not a number. Return values "
     "in this range."},
    {BT_FEM_UNUSED_NODES, "BT_FEM_UNUSED_NODES", "unused nodes",
     "Some nodes belong to no element: they stand still, or go where they are written. Remove them from the mesh if "
     "they are not meant."},
    {BT_FEM_CHANGED_MESH, "BT_FEM_CHANGED_MESH", "mesh changed",
     "Nodes or tetrahedra were appended, removed or connected otherwise, and the body was set up anew without its "
     "targets and attachments. Set these again."},
    {BT_FEM_BAD_SURFACE, "BT_FEM_BAD_SURFACE", "surface does not collide",
     "The surface that was to collide cannot, and the boundary of the tetrahedra does in its place. Mend what the "
     "message names."},
    {BT_FEM_BAKED_UNUSED, "BT_FEM_BAKED_UNUSED", "baked factor unused",
     "The baked factor was not used, and a new one made: it is larger than the solver's limit, or the rest shape is "
     "another. Bake the body as it is used."},
    {BT_FEM_PENETRATING, "BT_FEM_PENETRATING", "deep penetration",
     "Something was deeper inside the body than a hundredth of its size, or the body in something: it started there, "
     "or is crushed. Start bodies apart; take a stiffer material, a finer mesh or smaller steps."},
    {BT_FEM_INSIDE_OUT, "BT_FEM_INSIDE_OUT", "elements inside out",
     "Some elements were inside out: the body is crushed or twisted beyond what its elements can follow. Take a "
     "stiffer material, the Neo-Hookean law, a coarser mesh, lighter loads or smaller steps."},
    {BT_FEM_SLIVERS, "BT_FEM_SLIVERS", "sliver elements",
     "Some elements are slivers, flatter than a thousandth of their longest edge cubed. They cost iterations, and the "
     "solve may miss its tolerance. Take a better mesh, or a cage."},
    {BT_FEM_SOLVED_AFTER, "BT_FEM_SOLVED_AFTER", "solved after rigid bodies",
     "The body was solved after Bullet's rigid solver, not together with it: something that it is joined to sleeps, or "
     "belongs to another batch or to a multibody. Keep what is joined to it awake."},
    {BT_FEM_NOT_SPLIT, "BT_FEM_NOT_SPLIT", "could not split",
     "The body had to split and could not, and has no strength from then on. Allow larger factors, take a coarser "
     "mesh, and set the strength again."},
    {BT_FEM_TOO_SOFT, "BT_FEM_TOO_SOFT", "too soft",
     "The body is too soft for its own weight: rho g H exceeds E / 2 with a linear law, so that it sinks into itself. "
     "Take the Neo-Hookean law, a larger Young's modulus, or a smaller or lighter body."},
    {BT_FEM_ENERGY, "BT_FEM_ENERGY", "energy limited",
     "The step would have created energy, as elements turned or were crushed too far within it, and the body's elastic "
     "motion was shortened. Take smaller steps or a softer material."},
    {BT_FEM_BAD_CONSTRAINT, "BT_FEM_BAD_CONSTRAINT", "bad rigid constraint",
     "A joint or contact of rigid bodies near the body was left out, as it was not finite or had a lower limit above "
     "the "
     "upper one, or it had a negative softness. Mend the values that were written to it."},
};

}  // namespace

const btFemFlagText* btFemFlagText::find(int flag)
{
    const auto* const found = std::find_if(std::begin(kFlagTexts), std::end(kFlagTexts),
                                           [flag](const btFemFlagText& text) { return text.m_flag == flag; });
    return found == std::end(kFlagTexts) ? nullptr : found;
}

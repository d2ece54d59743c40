# SPDX-License-Identifier: Zlib
# Copyright (c) 2026 The BulletFEM authors
"""Meshes, materials, baked bodies, rigid bodies and joints."""
import copy

import numpy as np
import pytest

import bulletfem as bf
from conftest import G, ROOT, cube_mesh

PRESETS = ["rubber", "foam", "jelly", "flesh", "wood", "clay", "lead", "mild_foam"]
BEAR = ROOT / "demos" / "crowd" / "bear.off"


def test_meshes_have_volumes():
    assert np.isclose(bf.Mesh.box((1, 2, 3), (2, 2, 2)).volume, 6)
    assert np.isclose(bf.Mesh.sphere(0.5, 10).volume, np.pi / 6, rtol=0.05)
    assert np.isclose(bf.Mesh.cylinder(0.5, 2, 8, 4).volume, np.pi / 2, rtol=0.05)
    mesh = cube_mesh()
    assert mesh.positions.shape == (27, 3) and mesh.tets.shape == (40, 4) and mesh.surface.shape == (48, 3)
    assert mesh.regions.shape == (0,) and not mesh.is_cage
    assert np.array_equal(bf.Mesh(mesh.positions, mesh.tets).tets, mesh.tets)


@pytest.mark.parametrize(
    "make", [lambda: bf.Mesh.box((1, 1), (2, 2, 2)), lambda: bf.Mesh.box((1, 1, 1), (2, 2, 0)),
             lambda: bf.Mesh.box((1, 1, -1), (2, 2, 2)), lambda: bf.Mesh.box((1, 1, 1), (1000, 1000, 1000)),
             lambda: bf.Mesh.sphere(-1, 4), lambda: bf.Mesh.sphere(1, 1), lambda: bf.Mesh.cylinder(1, 1, 3, 1),
             lambda: bf.Mesh.box((1, 1, 1), (2, 2))])
def test_generators_refuse_values_out_of_range(make):
    with pytest.raises(ValueError):
        make()


def test_box_wants_integer_cells():
    with pytest.raises(TypeError, match="cells has dtype float64"):
        bf.Mesh.box((1, 1, 1), (2.0, 2, 2))


def test_mesh_files_are_read():
    mesh = bf.Mesh.read(ROOT / "demos" / "scenes" / "bar.mesh", scale=2)
    assert mesh.volume > 0 and len(mesh.tets) > 0
    assert bf.Mesh.read(str(ROOT / "demos" / "scenes" / "bar.mesh")).volume == pytest.approx(mesh.volume / 8)
    with pytest.raises(RuntimeError, match="missing.msh"):
        bf.Mesh.read("missing.msh")
    with pytest.raises(ValueError, match="scale"):
        bf.Mesh.read(ROOT / "demos" / "scenes" / "bar.mesh", scale=-1)


@pytest.mark.skipif(not BEAR.exists(), reason="there is no bear.off")
def test_cages_embed_surfaces(world):
    mesh = bf.Mesh.read_surface(BEAR, 1, tets=500)
    assert mesh.is_cage
    world.add_rigid_body(bf.Shape.plane())
    body = world.add_soft_body(mesh, bf.Material.rubber(), position=(0, 3, 0))
    surface = body.get_embedded_positions()
    assert len(surface) > 100 and body.embedded_triangles.max() < len(surface)
    world.step(30)
    assert np.allclose((body.get_embedded_positions() - surface).mean(axis=0)[1], -G * 0.5**2 / 2, rtol=0.1)


def test_cage_of_arrays():
    tetrahedron = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]])
    mesh = bf.Mesh.cage(tetrahedron, [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]], cell_size=0.25)
    assert mesh.volume > 0.999 / 6
    with pytest.raises(ValueError, match="cell"):
        bf.Mesh.cage(tetrahedron, [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]])
    with pytest.raises(ValueError, match="no inside"):
        bf.Mesh.cage(tetrahedron, [[0, 2, 1]], cell_size=0.25)
    with pytest.raises(IndexError):
        bf.Mesh.cage(tetrahedron, [[0, 2, 4]], cell_size=0.25)


@pytest.mark.parametrize("name", PRESETS)
def test_presets_are_damped_as_bodies_are(name):
    material = getattr(bf.Material, name)()
    material.validate()
    assert material.stiffness_damping == 0.005


def test_elastomers_have_hardness_and_loss_factor():
    rubber = bf.Material.shore_a(40)
    assert rubber.young_modulus == pytest.approx(1.69e6, rel=1e-3) and rubber.poisson_ratio == 0.499
    assert bf.Material.shore_d(40).young_modulus > bf.Material.shore_a(90).young_modulus
    assert rubber.loss_factor(10) == pytest.approx(0.1)
    rubber.set_loss_factor(0.3, 5)
    assert rubber.loss_factor(5) == pytest.approx(0.3)
    with pytest.raises(ValueError, match=r"\[Shore A\] is 5"):
        bf.Material.shore_a(5)
    with pytest.raises(ValueError, match="loss factor"):
        rubber.set_loss_factor(-1, 5)


def test_laws_have_constants():
    rubber = bf.Material(law="ogden", law_constants={"mu1": 5e5, "alpha1": 2})
    assert rubber.law == "ogden" and rubber.law_constants["mu1"] == 5e5 and rubber.law_constants["alpha2"] == 5
    assert bf.Material(law="neo_hooke").law_constants == {}
    with pytest.raises(ValueError, match="no constant of the law ogden"):
        rubber.law_constants = {"nu": 1}
    with pytest.raises(ValueError, match="law is 'treacle': it must be one of hooke, neo_hooke"):
        bf.Material(law="treacle")


def test_materials_have_values():
    material = bf.Material(young_modulus=2e6, poisson_ratio=0.45, law="neo_hooke", relaxation=())
    assert material.young_modulus == 2e6 and material.law == "neo_hooke" and material.mean_dilatation == "automatic"
    assert material == material.copy() and material is not material.copy()
    assert copy.deepcopy(material) == material
    material.density = 5
    assert material != bf.Material()
    assert bf.Material().stiffness_damping == 0.005
    assert [bf.Material().bending, bf.Material(bending="plain").bending] == ["automatic", "plain"]
    relaxing = bf.Material(relaxation=[[0.2, 1], [0.1, 10]])
    assert np.array_equal(relaxing.relaxation, [[0.2, 1], [0.1, 10]])


@pytest.mark.parametrize(
    "values", [{"young_modulus": 0}, {"young_modulus": np.nan}, {"poisson_ratio": 0.5}, {"density": -1}, {"law": "hook"},
               {"mean_dilatation": "yes"}, {"bending": "yes"}, {"relaxation": [[0.5, 1]] * 4}, {"relaxation": [[2, 1]]},
               {"relaxation": [1, 2]}, {"law": "neo_hooke", "yield_stress": 1e3}, {"along": (0, 0, 0)}, {"young_moduli": (1, 2)},
               {"law": "orthotropic", "poisson_ratios": (2, 2, 2)}])
def test_unusable_materials_are_refused(values):
    with pytest.raises(ValueError):
        bf.Material(**values)


def test_unknown_values_are_refused():
    with pytest.raises(TypeError, match="'young'"):
        bf.Material(young=1e6)
    with pytest.raises(TypeError, match="young_modulus"):
        bf.Material(young_modulus="1e6")


def sag(materials):
    world = bf.World(numerical_damping=1)
    mesh = bf.Mesh.box((1, 0.1, 0.1), (10, 2, 2))
    beam = world.add_soft_body(mesh, materials(mesh), pins=np.flatnonzero(mesh.positions[:, 0] == 0))
    world.step(200)
    return -(beam.positions - mesh.positions)[:, 1].min()


def test_materials_of_elements_are_used():
    base = bf.Material(young_modulus=5e6, poisson_ratio=0.2, bending="plain")
    soft = sag(lambda mesh: base)
    equal = sag(lambda mesh: bf.ElementMaterials(base, young_modulus=np.full(len(mesh.tets), 5e6)))
    stiff = sag(lambda mesh: bf.ElementMaterials(base, young_modulus=np.full(len(mesh.tets), 1e7)))
    regions = sag(lambda mesh: bf.ElementMaterials.of_regions(
        np.arange(len(mesh.tets)) % 2, {0: base, 1: bf.Material(young_modulus=1e7, poisson_ratio=0.2, bending="plain")}))
    assert np.isclose(equal, soft, rtol=1e-3)
    assert np.isclose(stiff, soft / 2, rtol=0.03)
    assert stiff < regions < soft


def test_axes_turn_with_the_mesh(free):
    wood = bf.Material(law="orthotropic", young_moduli=(1e7, 1e6, 1e6), along=(1, 0, 0), across=(0, 1, 0),
                       bending="plain")
    results = []
    for orientation in ((0, 0, 0, 1), (0, 0, np.sqrt(0.5), np.sqrt(0.5))):
        world = bf.World(gravity=(0, 0, 0), numerical_damping=1)
        mesh = bf.Mesh.box((1, 0.2, 0.2), (8, 2, 2))
        bar = world.add_soft_body(mesh, wood, orientation=orientation)
        ends = [np.flatnonzero(mesh.positions[:, 0] == end) for end in (0, 1)]
        pull = np.zeros((bar.node_count, 3))
        direction = np.array((1, 0, 0)) if orientation[3] == 1 else np.array((0, 1, 0))
        pull[ends[0]] = -direction * 1000 / len(ends[0])
        pull[ends[1]] = direction * 1000 / len(ends[1])
        world.step(150, after=lambda w: bar.add_forces(pull))
        span = bar.positions[ends[1]].mean(axis=0) - bar.positions[ends[0]].mean(axis=0)
        results.append(np.linalg.norm(span) - 1)
    assert np.isclose(results[0], results[1], rtol=1e-3)
    assert np.isclose(results[0], 1000 / 0.04 / 1e7, rtol=0.2)


@pytest.mark.parametrize("change", [{"young_modulus": np.ones(3)}, {"density": np.ones((40, 1))}, {"along": np.ones(40)},
                                    {"young_modulus": -np.ones(40)}, {"poisson_ratio": np.full(40, np.nan)}])
def test_unusable_element_materials_are_refused(world, change):
    with pytest.raises(ValueError):
        world.add_soft_body(cube_mesh(), bf.ElementMaterials(bf.Material(), **change))
    assert world.soft_bodies == []
    world.step()


def test_labels_need_materials(world):
    for labels, text in ((np.zeros(40, int), "label 0"), (np.ones(39, int), "labels has 39")):
        with pytest.raises(ValueError, match=text):
            world.add_soft_body(cube_mesh(), bf.ElementMaterials.of_regions(labels, {1: bf.Material()}))
    with pytest.raises(TypeError, match="float64"):
        bf.ElementMaterials.of_regions(np.zeros(40), {0: bf.Material()})
    with pytest.raises(ValueError, match="empty"):
        bf.ElementMaterials.of_regions(np.zeros(40, int), {})


def test_baked_bodies_move_as_others_do(tmp_path, world):
    mesh = cube_mesh(3)
    baked = bf.BakedBody.bake(mesh, bf.Material.rubber(), step=1 / 60, pins=[0, 1])
    baked.write(tmp_path / "cube.bfem")
    again = bf.BakedBody.read(tmp_path / "cube.bfem")
    assert again.node_count == 64 and again.tet_count == len(mesh.tets)
    bodies = [world.add_soft_body(again), bf.World().add_soft_body(mesh, bf.Material.rubber(), pins=[0, 1])]
    for body in bodies:
        body.world.step(40)
    assert np.array_equal(bodies[0].positions, bodies[1].positions)
    bodies[0].unpin([0])
    assert bodies[0].masses[0] > 0
    with pytest.raises(ValueError, match="baked body has its own"):
        world.add_soft_body(again, bf.Material())
    with pytest.raises(RuntimeError, match="missing.bfem"):
        bf.BakedBody.read("missing.bfem")
    (tmp_path / "bad.bfem").write_bytes((tmp_path / "cube.bfem").read_bytes()[:-9])
    with pytest.raises(RuntimeError, match="bad.bfem"):
        bf.BakedBody.read(tmp_path / "bad.bfem")


@pytest.mark.parametrize("pins,kind", [([99], IndexError), ([-1], IndexError), ([0.5], TypeError), ([[1]], ValueError)])
def test_unusable_pins_are_refused(world, pins, kind):
    with pytest.raises(kind, match="pins"):
        world.add_soft_body(cube_mesh(), pins=pins)
    assert world.soft_bodies == []


def shapes():
    cube = np.array(np.meshgrid([-1, 1], [-1, 1], [-1, 1])).reshape(3, 8).T * 0.1
    return {"box": bf.Shape.box((0.2, 0.2, 0.2)), "sphere": bf.Shape.sphere(0.1), "cylinder": bf.Shape.cylinder(0.1, 0.2),
            "capsule": bf.Shape.capsule(0.05, 0.1), "hull": bf.Shape.hull(cube),
            "compound": bf.Shape.compound([(bf.Shape.box((0.2, 0.1, 0.2)), (0, y, 0), (0, 0, 0, 1)) for y in (-0.05, 0.05)])}


@pytest.mark.parametrize("name", ["box", "sphere", "cylinder", "capsule", "hull", "compound"])
def test_shapes_rest_on_the_ground(world, name):
    world.add_rigid_body(bf.Shape.plane())
    body = world.add_rigid_body(shapes()[name], 2, position=(0, 0.12, 0))
    world.step(120)
    assert abs(body.position[1] - 0.1) < 0.01


def test_soft_bodies_rest_on_meshes(world):
    floor = np.array([[-2, 0, -2], [2, 0, -2], [2, 0, 2], [-2, 0, 2]])
    ground = world.add_rigid_body(bf.Shape.mesh(floor, [[0, 2, 1], [0, 3, 2]]))
    body = world.add_soft_body(cube_mesh(low=0.01), bf.Material.rubber())
    world.step(120)
    assert np.isclose(body.contact_force(ground)[1], body.mass * G, rtol=0.01)
    assert set(body.contacts["triangle"]) <= {0, 1}


@pytest.mark.parametrize(
    "make", [lambda: bf.Shape.box((1, 0, 1)), lambda: bf.Shape.sphere(0), lambda: bf.Shape.plane((0, 0, 0)),
             lambda: bf.Shape.hull(np.zeros((3, 3))), lambda: bf.Shape.hull(np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [1, 1, 0]])),
             lambda: bf.Shape.mesh(np.zeros((3, 3)), np.zeros((0, 3), int)), lambda: bf.Shape.compound([]),
             lambda: bf.Shape.compound([(bf.Shape.plane(), (0, 0, 0), (0, 0, 0, 1))])])
def test_unusable_shapes_are_refused(make):
    with pytest.raises(ValueError):
        make()


@pytest.mark.parametrize("parts", [[1], [(1, 2, 3)], [(bf.Shape.sphere(1), (0, 0, 0))]])
def test_parts_of_compounds_are_checked(parts):
    with pytest.raises(TypeError, match="parts has"):
        bf.Shape.compound(parts)


def test_planes_and_kinematic_bodies_have_no_mass(world):
    for shape, settings in ((bf.Shape.plane(), {}), (bf.Shape.sphere(1), {"kinematic": True})):
        with pytest.raises(ValueError, match="mass is not 0"):
            world.add_rigid_body(shape, 1, **settings)


def test_bodies_without_mass_have_no_velocity(world):
    for name in ("velocity", "angular_velocity"):
        with pytest.raises(ValueError, match="velocity is not 0"):
            world.add_rigid_body(bf.Shape.sphere(1), **{name: (1, 0, 0)})


def test_rigid_bodies_move(free):
    body = free.add_rigid_body(bf.Shape.sphere(0.1), 2, velocity=(1, 0, 0), angular_velocity=(0, 1, 0))
    free.step(60)
    assert np.allclose(body.position, (1, 0, 0), atol=0.02) and np.allclose(body.angular_velocity, (0, 1, 0), atol=1e-6)
    body.velocity = (0, 0, 0)
    body.apply_impulse((0, 4, 0))
    assert np.allclose(body.velocity, (0, 2, 0))
    body.velocity = (0, 0, 0)
    body.apply_force((0, 0, 120))
    body.apply_torque((0, 0, 1))
    free.step()
    assert np.allclose(body.velocity, (0, 0, 1)) and body.angular_velocity[2] > 0
    body.position = (5, 0, 0)
    body.orientation = (0, 0, 1, 1)
    assert np.allclose(body.position, (5, 0, 0)) and np.isclose(body.orientation[2], np.sqrt(0.5))
    body.apply_impulse((0, 1, 0), at=body.position + (0.1, 0, 0))
    body.friction, body.restitution = 0.25, 0.5
    assert body.friction == 0.25 and body.restitution == 0.5 and body.mass == 2 and not body.is_kinematic
    with pytest.raises(ValueError, match="restitution"):
        body.restitution = 2


def test_fixed_bodies_feel_no_forces(world):
    ground = world.add_rigid_body(bf.Shape.plane())
    for push in (lambda: ground.apply_force((0, 1, 0)), lambda: ground.apply_impulse((0, 1, 0)),
                 lambda: setattr(ground, "velocity", (0, 1, 0))):
        with pytest.raises(ValueError, match="mass 0"):
            push()


def test_kinematic_bodies_carry_soft_ones(world):
    lift = world.add_rigid_body(bf.Shape.box((1, 0.1, 1)), kinematic=True, position=(0, -0.05, 0))
    body = world.add_soft_body(cube_mesh(low=0.001), bf.Material.rubber())
    world.step(60)
    for _ in range(60):
        lift.position = lift.position + (0, 0.01, 0)
        world.step()
    assert lift.is_kinematic and np.isclose(body.positions[:, 1].min(), 0.6, atol=0.01)


def test_bodies_sleep_and_wake(cube):
    cube.world.step(400)
    assert not cube.is_active
    cube.wake()
    assert cube.is_active


def test_hinges_turn_by_motors_within_limits(free):
    body = free.add_rigid_body(bf.Shape.box((0.2, 0.2, 0.2)), 1, position=(3, 0, 0))
    hinge = free.add_hinge(body, None, (3, 0, 0), (0, 0, 1))
    hinge.set_motor(0.5, 10)
    free.step(60)
    assert np.isclose(hinge.position, 0.5, atol=0.01) and np.allclose(body.angular_velocity, (0, 0, 0.5), atol=1e-6)
    hinge.set_limits(-1, 0.7)
    free.step(60)
    assert np.isclose(hinge.position, 0.7, atol=0.01)


def test_sliders_move_by_motors_within_limits(free):
    body = free.add_rigid_body(bf.Shape.box((0.2, 0.2, 0.2)), 1)
    slider = free.add_slider(body, None, (0, 1, 0))
    slider.set_motor(0.5, 10)
    free.step(60)
    assert np.isclose(slider.position, 0.5, atol=0.02) and np.isclose(body.position[1], slider.position, atol=0.01)
    slider.set_limits(-1, 0.6)
    free.step(60)
    assert np.isclose(body.position[1], 0.6, atol=0.01)


def test_balls_and_fixed_joints_hold(world):
    a = world.add_rigid_body(bf.Shape.sphere(0.1), 1, position=(0.5, 0, 0))
    b = world.add_rigid_body(bf.Shape.sphere(0.1), 1, position=(0.8, 0, 0))
    ball = world.add_ball_joint(a, None, (0, 0, 0))
    fixed = world.add_fixed_joint(b, a)
    world.step(30)
    assert np.isclose(np.linalg.norm(a.position), 0.5, atol=0.01)
    assert np.isclose(np.linalg.norm(a.position - b.position), 0.3, atol=0.02)
    assert ball.exists
    ball.remove()
    assert not ball.exists
    world.step(30)
    assert np.linalg.norm(a.position) > 0.7
    world.remove(a)
    assert not fixed.exists
    for use in (lambda: fixed.set_limits(0, 1), lambda: ball.position, lambda: ball.remove()):
        with pytest.raises(RuntimeError, match="Joint . was removed"):
            use()


def test_joints_refuse_what_they_cannot_join(free):
    a = free.add_rigid_body(bf.Shape.sphere(0.1), 1)
    with pytest.raises(ValueError, match="one body"):
        free.add_fixed_joint(a, a)
    with pytest.raises(TypeError, match="b is 3"):
        free.add_fixed_joint(a, 3)
    with pytest.raises(ValueError, match="axis is 0"):
        free.add_hinge(a, None, (0, 0, 0), (0, 0, 0))
    fixed = free.add_fixed_joint(a, None)
    with pytest.raises(ValueError, match="neither"):
        fixed.set_motor(1, 1)
    with pytest.raises(ValueError, match="upper"):
        free.add_slider(a, None, (1, 0, 0)).set_limits(1, 0)

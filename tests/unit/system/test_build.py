"""Arrays of a drive, on a mesh that stays, and on another one."""

from importlib.resources import files

import numpy as np
import pytest

import beltdyn as bd
from beltdyn.errors import ModelError
from beltdyn.model import Drive, prepare
from beltdyn.quadrature import gauss_points
from beltdyn.system.build import Closure, belt_system, drive_system, on_other_mesh, staying_system
from beltdyn.system.state import belt_section


def test_section_of_the_papers_belt(drive: Drive) -> None:
    belt = drive.belt.replace(shear_correction=13 / 15.3)
    section = belt_section(belt)
    assert section.axial == belt.axial_stiffness
    assert section.bending == belt.bending_stiffness
    assert section.quartic == pytest.approx(1e8 * 1e-12 / 80 * 0.01)
    assert section.shear == pytest.approx(13 / 15.3 * 1e8 / 2.6 * 1e-4 * 0.01)
    assert section.shear_gradient == pytest.approx(section.shear * 1e-4 / 12)
    assert section.thickness == pytest.approx(1e4)
    assert section.mass == belt.mass_per_length
    assert section.rotary_inertia == belt.rotary_inertia


@pytest.mark.parametrize(("factor", "field"), [("axial_factor", "axial"), ("bending_factor", "bending")])
def test_factors_leave_thickness_and_inertia_alone(drive: Drive, factor: str, field: str) -> None:
    before, after = belt_section(drive.belt), belt_section(drive.belt.replace(**{factor: 3.0}))
    assert getattr(after, field) != getattr(before, field)
    assert (after.thickness, after.mass, after.rotary_inertia) == (before.thickness, before.mass, before.rotary_inertia)


def test_damping_is_stiffness_times_its_time(drive: Drive) -> None:
    belt = drive.belt.replace(stretch_damping_time=2e-4, bending_damping_time="3 ms", axial_factor=2.0)
    section = belt_section(belt)
    assert section.axial_damping == pytest.approx(2e-4 * section.axial)
    assert section.bending_damping == pytest.approx(3e-3 * section.bending)


def test_weight_joins_the_forces_on_the_nodes(drive: Drive) -> None:
    heavy = drive_system(prepare(drive.replace(gravity=(0.0, "-9.81 m/s^2"))))
    weight = drive.belt.mass_per_length * drive.belt_length * 9.81
    assert heavy.supports.force.reshape(-1, 6)[:, :2].sum(axis=0) == pytest.approx([0.0, -weight])
    pulled = belt_system(drive.belt, forces=[(0, (0.0, 5.0))], gravity=(0.0, -9.81))
    assert pulled.supports.force.reshape(-1, 6)[:, 1].sum() == pytest.approx(5.0 - weight)


@pytest.mark.parametrize(("closure", "extra"), [("shared_node", 0), ("multipliers", 1), ("open", 1)])
def test_nodes_by_closure(drive: Drive, closure: Closure, extra: int) -> None:
    system = belt_system(drive.belt, closure=closure)
    assert system.nodes == drive.elements + extra
    assert system.closed == (closure == "shared_node")
    assert system.joint == (closure == "multipliers")
    assert system.supports.fixed.shape == system.supports.force.shape == (6 * system.nodes,)
    assert system.supports.moment.shape == (system.nodes,)
    assert not system.supports.any_fixed


def test_the_elements_make_up_the_belt(drive: Drive) -> None:
    system = drive_system(prepare(drive))
    assert system.length.sum() == pytest.approx(drive.belt_length)
    shift = np.tile([1, 0, 0, 0, 0, 0], 2)
    mass = np.einsum("i,kij,j->", shift, system.mass, shift)
    assert mass == pytest.approx(drive.belt.mass_per_length * drive.belt_length)
    np.testing.assert_array_equal(system.element.elastic.points, gauss_points(drive.belt.quadrature_points)[0])


def test_pulleys(drive: Drive) -> None:
    system = drive_system(prepare(drive))
    pulleys = system.pulleys
    np.testing.assert_array_equal(pulleys.center, [pulley.center for pulley in drive.pulleys])
    np.testing.assert_array_equal(pulleys.radius, [pulley.radius for pulley in drive.pulleys])
    np.testing.assert_array_equal(pulleys.friction, [drive.contact.friction] * 2)
    np.testing.assert_array_equal(pulleys.shaft, [0, 1])
    np.testing.assert_array_equal(pulleys.carrier, [-1, -1])
    np.testing.assert_array_equal(system.bodies.unknown, [-1, 0])
    np.testing.assert_array_equal(system.bodies.reach, pulleys.radius)


def test_supports_and_loads(drive: Drive) -> None:
    system = belt_system(
        drive.belt, fixed=[(0, 1), (-1, 5)], forces=[(-1, (2.0, 3.0)), (-1, (1.0, 0.0))], moments=[(2, 4.0)]
    )
    np.testing.assert_array_equal(np.flatnonzero(system.supports.fixed), [1, 6 * system.nodes - 1])
    np.testing.assert_array_equal(system.supports.force.reshape(-1, 6)[-1], [3, 3, 0, 0, 0, 0])
    assert system.supports.moment[2] == system.supports.moment.sum() == 4.0


def test_pulleys_need_contact(drive: Drive) -> None:
    with pytest.raises(ModelError, match="contact is missing"):
        belt_system(drive.belt, drive.pulleys)


def flat(value: object) -> list[np.ndarray]:
    """All numbers of a tree of tuples."""
    return [one for each in value for one in flat(each)] if isinstance(value, tuple) else [np.asarray(value)]


@pytest.mark.parametrize("name", ["accessory_drive", "conveyor", "washing_machine"])
def test_other_mesh_is_as_one_made_anew(name: str) -> None:
    """With tensioners, hub chains, hysteresis and weight; machines are taken over."""
    drive: Drive = bd.load(str(files("beltdyn") / "examples" / f"{name}.toml"))
    coarse, fine = (np.full(count, drive.belt_length / count) for count in (9, 14))
    fine[:7], fine[7:] = 0.8 * fine[:7], 1.2 * fine[7:]
    system = staying_system(prepare(drive), coarse)
    other, anew = on_other_mesh(prepare(drive), system, fine), staying_system(prepare(drive), fine)
    assert type(other.frame) is type(anew.frame)
    assert other.tensioners is system.tensioners
    for one, expected in zip(flat(other), flat(anew), strict=True):
        np.testing.assert_array_equal(one, expected)

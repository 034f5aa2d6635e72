"""Every key of a drive file that an analysis takes changes its results, or is refused, or cannot matter to it.

Each key of a drive is changed to another valid value, keys that are open among them. Results that stay the same to the
last digits were computed without that key.
"""

import re
import typing
from collections.abc import Callable, Iterator, Mapping
from contextlib import suppress
from typing import Any

import numpy as np
import pytest

import beltdyn as bd
from beltdyn.arrays import FloatArray
from beltdyn.errors import BeltdynError
from beltdyn.model import Drive
from beltdyn.parts.kind_fields import NameOf
from beltdyn.parts.part import Part
from beltdyn.parts.text_file import entry_name
from beltdyn.results import Result

SPECIFIED = {"elements": 170, "force_tolerance": 2e-3, "max_step": 2e-5, "shear_correction": 0.8, "start_at": 0.01}
"""Values of keys that are open."""
CHANGES, MOVE, LOAD = (1.03, 3.0), 1e-4, 0.01
"""Factors on a number, change of a coordinate in m, and value in place of zero, in SI units."""
SAME = 1e-9
"""Relative difference of results up to which they count as the same; a search ends at 1e-9 of a radius."""

TEXTS = r"name|description|project|author|.*\.source"
JUDGED = (
    r"limits\..*|duty.*|.*\.(cord_fatigue|rib_fatigue)\..*|belt\.(largest_tension|smallest_diameter|temperature)|"
    + (r"belt\.(strength|permanent_elongation|thermal_expansion|temperature_range)|.*\.travel")
)
SOLD = r"belt\.(measuring_force|poissons_ratio)|.*\.(diameter_kind|sense)"
OUT_OF_PLANE = r".*\.(axial_offset|tilt)|belt\.largest_fleeting_angle"
ABSENT = r"belt\.compression_set|.*\.(mass|center_of_mass|moving_mass)|.*\.creep_speed"
RUNS = r"simulation\.(?!duration).*|.*\.inertia|tensioner.*\.damping|.*\.(schedule|speed)\.(start|end)|.*_friction"
TRAVELLING = r"(belt|contact)\.(integration|quadrature_points|sampling)|belt\.shear_correction"
MOTION = (
    r"pulley.*\.(torque|load|speed|harmonics|hub|friction).*|.*\.(damping|creep_ratio|standstill_creep|moment_arm|slip_radius)|"
    r"belt\..*(damping_time|loss_factor)|.*friction.*|belt\.wedge_angle|belt\.contact_stiffness|contact\.normal_law|rotation|simulation\.duration"
)
ALWAYS = (TEXTS, JUDGED, SOLD, OUT_OF_PLANE, ABSENT)
WITHOUT_EFFECT: Mapping[str, tuple[str, ...]] = {
    "steady_state": (*ALWAYS, RUNS, TRAVELLING, "simulation.duration"),
    "operating_map": (*ALWAYS, RUNS, TRAVELLING, "simulation.duration"),
    "equilibrium": (*ALWAYS, RUNS, MOTION, r"steady\..*"),
    "stroke": (*ALWAYS, RUNS, MOTION, r"steady\..*"),
    "simulate": (*ALWAYS, r"steady\..*", r"simulation\.field_interval"),
}
"""Keys that by their meaning cannot matter, as the manual says. To all: texts; limits and fatigue data; numbers that
are read of belts and pulleys as sold, or only checked; what has no effect in the plane; and what belongs to a part that
the drive lacks (weight without gravity, nips, dry friction). To states that stay: settings of runs, inertia, when ramps
begin, and elements of the travelling mesh, which results list as not used. At rest: what acts in motion alone,
and a stiffness that counts only where it is the largest of several."""


def changed_values(key: str, value: Any, annotation: Any) -> list[Any]:
    """Other values of a key, those that its type lists or numbers nearby."""
    if isinstance(value, bool):
        return [not value]
    listed = [one for one in _choices(annotation) if one != value]
    if listed:
        return listed
    if value is None:
        return [SPECIFIED[key]] if key in SPECIFIED else []
    if isinstance(value, int):
        return [value + 1]
    if isinstance(value, float):
        return [factor * value for factor in CHANGES] if value else [LOAD]
    if isinstance(value, tuple) and len(value) == 2 and all(isinstance(one, float) for one in value):
        return [[value[0] + MOVE, value[1]]]
    return []


def _choices(annotation: Any) -> list[Any]:
    if isinstance(annotation, NameOf):
        return list(annotation.choices)
    if typing.get_origin(annotation) is typing.Literal:
        return list(typing.get_args(annotation))
    return [choice for one in typing.get_args(annotation) for choice in _choices(one)]


def keys_of(part: Part, path: str = "") -> Iterator[tuple[str, list[Any]]]:
    """Paths of all keys of a part and of the parts within, with other values."""
    for name, field in type(part).model_fields.items():
        key, value = field.alias or name, getattr(part, name)
        inner = f"{path}.{key}" if path else key
        if isinstance(value, Part):
            yield from keys_of(value, inner)
        elif isinstance(value, tuple) and value and all(isinstance(one, Part) for one in value):
            for number, one in enumerate(value, 1):
                yield from keys_of(one, f"{inner}[{entry_name(one) or number}]")
        else:
            names = [one for one in field.metadata if isinstance(one, NameOf)]
            yield inner, changed_values(key, value, names[0] if names else field.annotation)


def changes_of(drive: Drive, only: str = ".*") -> Iterator[tuple[str, list[Drive]]]:
    """Keys of a drive, and the drives with other values there that are valid."""
    for path, values in keys_of(drive):
        if not re.fullmatch(only, path):
            continue
        found = list[Drive]()
        for value in values:
            with suppress(BeltdynError):
                found.append(drive.with_({path: value}))
        if found:
            yield path, found


def numbers(result: Result) -> dict[str, FloatArray]:
    """All numbers of a result."""
    found = {str(name): one.values for name, one in result.dataset.variables.items() if one.dtype.kind == "f"}
    return {name: np.asarray(values) for name, values in found.items()}


def is_same(first: Result, second: Result) -> bool:
    """Whether two results have the same numbers."""
    mine, other = numbers(first), numbers(second)
    return mine.keys() == other.keys() and all(
        one.shape == other[name].shape
        and np.allclose(one, other[name], rtol=SAME, atol=SAME * np.nanmax(np.abs(one), initial=0.0), equal_nan=True)
        for name, one in mine.items()
    )


def ignored(drive: Drive, analysis: str, only: str = ".*") -> list[str]:
    """Keys that an analysis takes and ignores: with all other values it has the same results."""
    compute = COMPUTE[analysis]
    plain, found = compute(drive), list[str]()
    for path, drives in changes_of(drive, only):
        if not any(re.fullmatch(pattern, path) for pattern in WITHOUT_EFFECT[analysis]):
            with suppress(BeltdynError):  # refused
                if all(is_same(plain, compute(changed)) for changed in drives):
                    found.append(path)
    return found


def _briefly(drive: Drive) -> Drive:
    return drive.with_({"simulation.duration": 0.03, "simulation.output_interval": 0.01})


COMPUTE: Mapping[str, Callable[[Drive], Result]] = {
    "steady_state": bd.steady_state,
    "operating_map": lambda drive: bd.operating_map(drive, load=[1.0]),
    "equilibrium": bd.equilibrium,
    "stroke": lambda drive: bd.stroke(drive, places=[0.0], count=3),
    "simulate": lambda drive: bd.simulate(drive),
}
MESH = r"belt\.elements|steady\..*|simulation\.force_tolerance"


@pytest.mark.parametrize(
    ("example", "analysis"),
    [
        ("alternator_drive", "steady_state"),
        ("alternator_drive", "operating_map"),
        ("alternator_drive", "equilibrium"),
        ("printer_axis", "stroke"),
    ],
)
def test_the_mesh_that_is_asked_for_is_used(example: str, analysis: str) -> None:
    assert not ignored(bd.example(example), analysis, MESH)


def test_least_number_of_elements() -> None:
    """The number of elements is the least of refined meshes, graded or equal."""
    drive = bd.example("alternator_drive")
    for elements in (80, 400):
        run = bd.steady_state(drive.with_({"belt.elements": elements}))
        assert elements <= int(run.dataset.attrs["mesh_elements"]) <= 2.1 * elements
        assert run.drive.belt.elements == elements
    assert bd.steady_state(drive).drive.belt.elements is None


def test_a_key_without_effect_is_noticed(monkeypatch: pytest.MonkeyPatch) -> None:
    """An analysis that leaves out a key is found out."""
    deaf = {"equilibrium": lambda drive: bd.equilibrium(drive.with_({"belt.elements": None}))}
    monkeypatch.setattr(f"{__name__}.COMPUTE", deaf)
    assert ignored(bd.example("alternator_drive"), "equilibrium", MESH) == ["belt.elements"]


@pytest.mark.slow
@pytest.mark.parametrize("analysis", ["steady_state", "equilibrium", "simulate"])
@pytest.mark.parametrize("example", ["alternator_drive", "package_conveyor", "timing_drive", "washing_machine"])
def test_every_key_is_used_or_refused(example: str, analysis: str) -> None:
    drive = bd.example(example)
    assert not ignored(_briefly(drive) if analysis == "simulate" else drive, analysis)


@pytest.mark.slow
@pytest.mark.parametrize("analysis", ["stroke", "equilibrium"])
def test_every_key_of_an_axis_is_used_or_refused(analysis: str) -> None:
    assert not ignored(bd.example("printer_axis"), analysis)

"""Fleeting angles, by the closed forms of parallel and angular misalignment."""

from collections.abc import Callable
from itertools import product
from typing import Any

import numpy as np
import pytest

from beltdyn.errors import ModelError
from beltdyn.model import Drive, advise, alignment, example, install, loads
from beltdyn.model.alignment import is_given

TEXT = """
[belt]
profile = "PK"
ribs = 4
installed_tension = 400
[[pulley]]
name = "left"
center = [0, 0]
radius = "60 mm"
speed = "1000 rpm"
{left}
[[pulley]]
name = "right"
center = ["400 mm", 0]
radius = "60 mm"
inertia = 0.01
{right}
[simulation]
duration = 1
"""
LENGTH, RADIUS = 0.4, 0.06


@pytest.fixture
def make() -> Callable[..., Drive]:
    return lambda left="", right="": loads(TEXT.format(left=left, right=right))


def test_parallel_misalignment(make: Callable[..., Drive]) -> None:
    """An offset of δ over a span of L: atan(δ/L) at both ends, with opposite signs on the way back."""
    found = alignment(make(right='axial_offset = "2 mm"'))
    angle = np.arctan(0.002 / LENGTH)
    np.testing.assert_allclose(found.span_lengths, LENGTH)
    np.testing.assert_allclose(found.angles, [[angle, angle], [-angle, -angle]], rtol=1e-12)
    np.testing.assert_allclose(found.worst, np.abs(found.angles), rtol=1e-12)


def test_a_tilt_across_the_span(make: Callable[..., Drive]) -> None:
    """A shaft that leans along the spans by γ: the fleeting angle at its pulley is γ, and none at the other."""
    found = alignment(make(right='tilt = [0, "0.3 deg"]'))
    gamma = np.radians(0.3)
    np.testing.assert_allclose(found.angles, [[0.0, gamma], [-gamma, 0.0]], atol=1e-15)


def test_a_tilt_about_the_line_of_centers(make: Callable[..., Drive]) -> None:
    """The belt enters R tan γ out of the plane on one side: atan(R tan γ / L) at both ends."""
    belt_radius = RADIUS + make().belt.pitch_offset
    found = alignment(make(left='tilt = ["0.5 deg", 0]'))
    angle = np.arctan(belt_radius * np.tan(np.radians(0.5)) / LENGTH)
    np.testing.assert_allclose(np.abs(found.angles), angle, rtol=1e-12)
    assert found.angles[0, 0] > 0.0


def test_a_crank_that_leans_as_a_whole_is_aligned(make: Callable[..., Drive]) -> None:
    """Both shafts tilted alike, and offset as the tilted plane is: no misalignment."""
    gamma = np.radians(1.0)
    both = f"tilt = [0, {gamma}]"
    found = alignment(make(left=both, right=f"{both}\naxial_offset = {-LENGTH * np.tan(gamma)}"))
    np.testing.assert_allclose(found.angles, 0.0, atol=1e-15)


def test_the_worst_case_is_that_of_all_signs(make: Callable[..., Drive]) -> None:
    """Over all corners of the tolerances no fleeting angle is larger, and one is as large."""
    sizes = {"left": (0.0004, 0.002, 0.003), "right": (0.0003, 0.001, 0.002)}
    given = {"left": (0.001, 0.004, -0.001), "right": (-0.0005, 0.0, 0.002)}

    def keys(name: str) -> str:
        texts = [
            f'"{value} ± {size} {unit}"' for value, size, unit in zip(given[name], sizes[name], "mrr", strict=True)
        ]
        offset, *tilts = [text.replace(' r"', ' rad"') for text in texts]
        return f"axial_offset = {offset}\ntilt = [{', '.join(tilts)}]"

    drive = make(left=keys("left"), right=keys("right"))
    largest = np.zeros((2, 2))
    for signs in product((-1.0, 1.0), repeat=6):
        moved = {
            path: value + sign * size
            for sign, (path, value, size) in zip(
                signs,
                [
                    (f"pulley[{name}].{key}", given[name][number], sizes[name][number])
                    for name in sizes
                    for number, key in enumerate(("axial_offset", "tilt[1]", "tilt[2]"))
                ],
                strict=True,
            )
        }
        largest = np.maximum(largest, np.abs(alignment(drive.with_(moved)).angles))
    np.testing.assert_allclose(alignment(drive).worst, largest, rtol=1e-4)


def test_the_offset_allowed(make: Callable[..., Drive]) -> None:
    """Half a degree over 400 mm is 3.49 mm, of which 2 mm are used; beyond it is negative."""
    whole = LENGTH * np.tan(np.radians(0.5))
    np.testing.assert_allclose(alignment(make()).allowed_offset, whole)
    np.testing.assert_allclose(alignment(make(right='axial_offset = "2 mm"')).allowed_offset, whole - 0.002)
    drive = make(right='axial_offset = "2 ± 0.5 mm"')
    np.testing.assert_allclose(alignment(drive).allowed_offset, whole - 0.0025)
    assert alignment(make(right='axial_offset = "5 mm"')).allowed_offset.max() < 0.0


def test_without_a_limit_there_is_no_offset_allowed(drive: Drive) -> None:
    found = alignment(drive)
    assert np.isnan(found.limit)
    assert np.isnan(found.allowed_offset).all()
    np.testing.assert_array_equal(found.angles, 0.0)
    assert not is_given(drive)


def test_a_fleeting_angle_beyond_the_limit_is_a_warning(make: Callable[..., Drive]) -> None:
    def told(drive: Drive) -> list[str]:
        return [str(one) for one in advise(drive, install(drive)) if "fleeting" in str(one)]

    assert told(make(right='axial_offset = "3 mm"')) == []
    (text,) = told(make(right='axial_offset = "3 ± 1 mm"'))
    assert "at a fleeting angle of 0.573° with tolerances, but the belt allows 0.5°" in text
    assert "by 0.509 mm" in text


def test_offsets_change_no_planar_result(make: Callable[..., Drive]) -> None:
    one, other = make(), make(right='axial_offset = "3 mm"\ntilt = [0.01, 0.01]')
    assert install(one).tension == install(other).tension


@pytest.mark.parametrize(
    ("keys", "words"),
    [('tilt = ["40 deg", 0]', "tilt"), ("tilt = [0.1]", "tilt"), ('axial_offset = "1 deg"', "axial_offset")],
)
def test_what_is_no_misalignment(make: Callable[..., Drive], keys: str, words: str) -> None:
    with pytest.raises(ModelError, match=words):
        make(right=keys)


def test_an_open_belt() -> None:
    with pytest.raises(ModelError, match="closed belt"):
        alignment(example("band_brake"))


def test_the_path_at_rest_counts(make: Callable[..., Any]) -> None:
    drive = make(right='axial_offset = "2 mm"')
    found = alignment(drive, install(drive).path)
    np.testing.assert_allclose(found.span_lengths, install(drive).path.span_lengths)

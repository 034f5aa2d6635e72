"""Tolerances as an engineer writes them, and what cannot be one."""

import math
import pickle

import numpy as np
import pytest

from beltdyn.errors import ModelError
from beltdyn.model import alignment, loads
from beltdyn.model.toml import dumps, edited
from beltdyn.parts.tolerances import tolerances_of
from validation.published.cases import demo_text


def with_radius(text: str) -> str:
    given, at = demo_text(), "radius = 0.08125"
    assert at in given
    return given.replace(at, f"radius = {text}", 1)


@pytest.mark.parametrize(
    ("text", "tolerance"),
    [
        ('"81.25 ± 0.1 mm"', 1e-4),
        ('"81.25 +- 0.1 mm"', 1e-4),
        ('"81.25+/-0.1mm"', 1e-4),
        ('"81.25 mm ± 2 %"', 0.02 * 0.08125),
        ('"81.25 mm +- .5%"', 0.005 * 0.08125),
    ],
)
def test_tolerances_have_the_unit_of_the_number(text: str, tolerance: float) -> None:
    drive = loads(with_radius(text))
    assert drive.pulleys[0].radius == pytest.approx(0.08125)
    assert tolerances_of(drive) == {"pulley[driver].radius": pytest.approx(tolerance)}


def test_they_go_with_the_text_of_the_drive() -> None:
    """Results keep that text, and files that are written with other numbers keep the tolerance."""
    drive = loads(with_radius('"81.25 ± 0.1 mm"'))
    again = pickle.loads(pickle.dumps(drive))
    assert tolerances_of(again) == tolerances_of(drive)
    changed = edited(drive, {"pulley[driver].radius": 0.082})
    assert '"82 ± 0.1 mm"' in changed
    assert tolerances_of(loads(changed)) == tolerances_of(drive)


@pytest.mark.parametrize(
    "text", ['"81.25 ± mm"', '"81.25 ± 0 mm"', '"81.25 ± 0.1 ± 0.2 mm"', '"81.25 ± -0.1 mm"', '"± 1 mm"']
)
def test_what_is_no_tolerance_is_refused(text: str) -> None:
    with pytest.raises(ModelError, match=r"driver.*(an unreadable tolerance|must be a number)"):
        loads(with_radius(text))


def test_drives_made_in_python_keep_them() -> None:
    """Through parts, copies with other values changed, and files; not where the number itself is given anew."""
    drive, width, tilt = loads(demo_text()), "belt.width", "pulley[driven].tilt[1]"
    made = drive.with_({width: "10 ± 0.2 mm", "pulley[driven].tilt": ["0 ± 0.1 deg", "0.2 deg"]})
    expected = pytest.approx({width: 2e-4, tilt: math.radians(0.1)}, rel=1e-9)
    assert tolerances_of(made) == expected
    copies = [made.with_({"belt.elements": 40}), made.replace(name="copy"), pickle.loads(pickle.dumps(made))]
    assert all(tolerances_of(one) == expected for one in [*copies, loads(dumps(made)), loads(made.text)])
    assert tolerances_of(made.with_({width: 0.011})).keys() == {tilt}
    belt = drive.belt.replace(width="10 ± 0.2 mm").replace(elements=40)
    assert tolerances_of(drive.replace(belt=belt)) == {width: pytest.approx(2e-4)}
    assert tolerances_of(made.replace(belt=drive.belt)).keys() == {tilt}
    assert belt.replace(width="10 mm").toleranced == {}


def test_alignment_in_python_is_that_of_the_file() -> None:
    text = demo_text().replace('name = "driven"', 'name = "driven"\naxial_offset = "1 ± 0.5 mm"', 1)
    plain = loads(demo_text()).with_({"pulley[driven].axial_offset": "1 ± 0.5 mm"})
    np.testing.assert_array_equal(alignment(plain).worst, alignment(loads(text)).worst)
    assert np.all(alignment(plain).worst > np.abs(alignment(plain).angles))

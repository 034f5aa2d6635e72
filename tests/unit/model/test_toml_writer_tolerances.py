"""Tolerances as an engineer writes them, and what cannot be one."""

import pickle

import pytest

from beltdyn.errors import ModelError
from beltdyn.model import loads
from beltdyn.model.toml_writer import edited, tolerances_of
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

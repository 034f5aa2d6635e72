"""What a notebook shows of a drive: the picture has the belt's length, and the table the pulleys."""

import math
import re
from importlib.resources import files

import numpy as np
import pytest

from beltdyn.model import Drive, Path, advise, install, loads
from beltdyn.show.notebook import picture, shortened

EXAMPLES = sorted(file.name for file in files("beltdyn").joinpath("examples").iterdir() if file.name.endswith(".toml"))


def example(name: str) -> Drive:
    return loads(files("beltdyn").joinpath("examples", name).read_text(encoding="utf-8"))


def drawn_length(belt: str) -> float:
    """Length of an SVG path of lines and circular arcs, by the rules of SVG."""
    numbers = [float(number) for number in re.findall(r"-?[\d.]+", belt)]
    x, y, total, rest = numbers[0], numbers[1], 0.0, numbers[2:]
    for at in range(0, len(rest), 9):
        if len(rest) == at + 2:  # an open belt ends with a line
            return total + math.dist((x, y), rest[at:])
        line, (radius, _, _, large, _), end = rest[at : at + 2], rest[at + 2 : at + 7], rest[at + 7 : at + 9]
        total += math.dist((x, y), line)
        half = math.asin(min(1.0, math.dist(line, end) / (2 * radius)))
        total += 2 * radius * (math.pi - half if large else half)
        x, y = end
    return total


@pytest.mark.parametrize("name", EXAMPLES)
def test_the_belt_is_drawn_in_its_length_around_its_pulleys(name: str) -> None:
    drive = example(name)
    drawn = picture(drive)
    scale = drawn.circles[0].radius / drive.pulleys[0].radius
    centers = np.array([(circle.x, -circle.y) for circle in drawn.circles]) / scale
    path = shortened(drive.path) if drive.ends else Path(centers, drive.path.radii)
    assert drawn_length(drawn.belt) == pytest.approx(scale * path.length, rel=2e-3)  # two decimals of a pixel
    assert drawn.is_shortened == (path.length < 0.999 * drive.path.length)
    assert [circle.name for circle in drawn.circles] == [pulley.name for pulley in drive.pulleys]
    for circle in drawn.circles:
        assert circle.radius < circle.x < drawn.width - circle.radius
        assert circle.radius < circle.y < drawn.height - circle.radius
        (x, y), half = circle.label, 3.0 * len(circle.name)
        assert half <= x <= drawn.width - half
        assert 5.0 <= y <= drawn.height - 5.0


def test_a_conveyor_of_a_kilometer_shows_its_pulleys() -> None:
    """Its gap of 1 km is cut to 15 diameters, and its height in proportion, to a diameter at least."""
    drive = example("conveyor_1km.toml")
    drawn = picture(drive)
    head, tail = drawn.circles
    assert drawn.is_shortened
    assert head.radius > 9.0  # pixels
    assert tail.radius / head.radius == pytest.approx(0.8)
    assert tail.x - head.x == pytest.approx(15.0 * 2.0 * head.radius + head.radius + tail.radius, rel=1e-3)
    assert tail.y - head.y == pytest.approx(2.0 * head.radius + head.radius + tail.radius, rel=1e-3)
    assert "shortened" in drive._repr_html_()


def test_a_notebook_shows_pulleys_tension_and_warnings(drive: Drive) -> None:
    shown = drive._repr_html_()
    assert shown.count("<circle") == 2
    assert re.findall(r'<th scope="row"[^>]*>(\w+)</th>', shown) == ["driver", "driven"]
    assert "N at rest" in shown
    for shown_drive in (drive, example("accessory_drive.toml"), example("crossed_belt.toml")):
        warnings = advise(shown_drive, install(shown_drive))
        assert shown_drive._repr_html_().count("<strong>Warning:</strong>") == len(warnings)

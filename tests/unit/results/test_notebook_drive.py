"""What a notebook shows of a drive: the picture has the belt's length, and the table the pulleys."""

import math
import re
from importlib.resources import files

import pytest

from beltdyn.model import Drive, advise, install, loads
from beltdyn.show.notebook import picture

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
    assert drawn_length(drawn.belt) == pytest.approx(scale * drive.path.length, rel=2e-3)  # two decimals of a pixel
    assert [circle.name for circle in drawn.circles] == [pulley.name for pulley in drive.pulleys]
    for circle in drawn.circles:
        assert circle.radius < circle.x < drawn.width - circle.radius
        assert circle.radius < circle.y < drawn.height - circle.radius


def test_a_notebook_shows_pulleys_tension_and_warnings(drive: Drive) -> None:
    shown = drive._repr_html_()
    assert shown.count("<circle") == 2
    assert re.findall(r'<th scope="row"[^>]*>(\w+)</th>', shown) == ["driver", "driven"]
    assert "N at rest" in shown
    for shown_drive in (drive, example("accessory_drive.toml"), example("crossed_belt.toml")):
        warnings = advise(shown_drive, install(shown_drive))
        assert shown_drive._repr_html_().count("<strong>Warning:</strong>") == len(warnings)

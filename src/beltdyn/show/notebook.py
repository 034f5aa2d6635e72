"""A drive and a result as a notebook shows them: picture, numbers, warnings."""

import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import cache

import numpy as np
from jinja2 import Environment, PackageLoader

from beltdyn.model.advice import advise
from beltdyn.model.drive import Drive
from beltdyn.model.path import Path
from beltdyn.model.prepared import install
from beltdyn.model.pulley import Pulley
from beltdyn.results.result import Result
from beltdyn.results.schema import runs_steadily
from beltdyn.show.sheet import sheet

# A drive as a small vector picture: its pulleys and the path of its belt, as text in SVG

_SIZE = 360.0
"""Longer side of the picture, pixels."""
_MARGIN = 0.06
"""Room around the drive, over its longer side."""
_LETTER, _GAP = 6.0, 5.0
"""Width of a letter of names, and their distance from a pulley, pixels."""
_LEVEL = 0.7
"""Cosine above which a name stands beside its pulley, and not above or below."""


@dataclass(frozen=True)
class Circle:
    """A pulley in the picture, pixels; `prescribed` says whether its speed is prescribed."""

    name: str
    x: float
    y: float
    radius: float
    prescribed: bool
    label: tuple[float, float]
    """The middle of its name: beyond its arc where the circle is too small."""


@dataclass(frozen=True)
class Picture:
    """The data of a template to draw a drive."""

    width: float
    """Width, pixels."""
    height: float
    """Height, pixels."""
    circles: tuple[Circle, ...]
    """The pulleys."""
    belt: str
    """Path of the belt's line of tension, in the language of the attribute ``d``."""


def picture(drive: Drive) -> Picture:
    """Draw a drive, with spring-loaded tensioners where the file has them."""
    path = drive.path
    reach = abs(path.radii)[:, None]
    points = np.concatenate([path.centers - reach, path.centers + reach, *([] if path.ends is None else [path.ends])])
    low, high = points.min(axis=0), points.max(axis=0)
    scale = _SIZE / max(high - low)
    room = _MARGIN * _SIZE
    width, height = (float(side) for side in scale * (high - low) + 2 * room)

    def place(x: float, y: float) -> tuple[float, float]:
        return room + scale * (x - low[0]), room + scale * (high[1] - y)

    def circle(number: int, pulley: Pulley) -> Circle:
        (x, y), radius = place(*path.centers[number].tolist()), scale * pulley.radius
        right, up = path.clear_way(number) or (0.0, -1.0)
        half = _LETTER * len(pulley.name) / 2.0
        outside = float(half > radius)
        away = radius + _GAP + half * (abs(right) > _LEVEL)
        label = x + outside * right * away, y - outside * up * (radius + 2.0 * _GAP)
        return Circle(pulley.name, x, y, radius, pulley.prescribed, label)

    circles = tuple(circle(number, pulley) for number, pulley in enumerate(drive.pulleys))
    return Picture(width, height, circles, outline(path, place, scale))


def outline(path: Path, place: Callable[[float, float], tuple[float, float]], scale: float) -> str:
    """Draw the line of a path."""
    x, y = place(*path.span_points[path.order[0], 0])
    steps = [f"M {x:.2f} {y:.2f}"]
    for span in path.order:
        x, y = place(*path.span_points[span, 1])
        steps.append(f"L {x:.2f} {y:.2f}")
        pulley = path.span_pulleys[span, 1]
        if pulley < 0:
            break
        radius, large = scale * abs(path.radii[pulley]), int(path.wrap_angles[pulley] > math.pi)
        x, y = place(*path.span_points[path.leaving[pulley], 0])
        steps.append(f"A {radius:.2f} {radius:.2f} 0 {large} {int(path.radii[pulley] < 0)} {x:.2f} {y:.2f}")
    return " ".join(steps)


@cache
def templates() -> Environment:
    """Templates of the pages that notebooks show; text is escaped."""
    return Environment(loader=PackageLoader("beltdyn"), autoescape=True, trim_blocks=True, lstrip_blocks=True)


def drive_html(drive: Drive) -> str:
    """Show a drive as HTML."""
    installation = install(drive)
    template = templates().get_template("drive.html.jinja")
    return template.render(
        picture=picture(drive),
        drive=drive,
        radii=drive.radii,
        wraps=np.degrees(drive.path.wrap_angles),
        tension=installation.tension,
        warnings=advise(drive, installation),
    )


def result_html(result: Result) -> str:
    """Show a result as HTML."""
    return (
        templates()
        .get_template("result.html.jinja")
        .render(
            drive=result.drive,
            picture=picture(result.drive),
            kind="steady running" if runs_steadily(result.dataset) else result.kind.replace("_", " "),
            status=result.status,
            sheet=sheet(result).parts,
            warnings=result.warnings,
        )
    )

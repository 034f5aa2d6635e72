"""A drive and a result as a notebook shows them: picture, numbers, warnings."""

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cache

import numpy as np
from jinja2 import Environment, PackageLoader

from beltdyn.arrays import FloatArray, IntArray
from beltdyn.model.advice import advise
from beltdyn.model.drive import Drive
from beltdyn.model.path import Path
from beltdyn.model.prepared import install
from beltdyn.model.pulley import Pulley
from beltdyn.results.result import Result
from beltdyn.results.schema import runs_steadily
from beltdyn.show.sheet import sheet

# A drive as a small vector picture: its pulleys and the path of its belt, as text in SVG

_PICTURE_SIZE = 360.0
"""Longer side of the picture, pixels."""
_MARGIN = 0.06
"""Room around the drive, over its longer side."""
_LETTER_WIDTH, _NAME_GAP = 6.0, 5.0
"""Width of a letter of names, and their distance from a pulley, pixels."""
_ARC_DISTANCE = 2.0
"""Least distance of a name inside a pulley from its rim, pixels; a name with less room stands outside."""
_MAX_GAP = 15.0
"""Longest gap between pulleys that is drawn in its length, in diameters of the largest pulley: 20 pixels for that."""
_BESIDE_COSINE = 0.7
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
    is_shortened: bool = False
    """Whether spans are drawn shorter than they are."""


def picture(drive: Drive) -> Picture:
    """Draw a drive, with spring-loaded tensioners where the file has them, and with long spans shortened."""
    path = shortened(drive.path)
    reach = abs(path.radii)[:, None]
    points = np.concatenate([path.centers - reach, path.centers + reach, *([] if path.ends is None else [path.ends])])
    scale = _PICTURE_SIZE / float(max(np.ptp(points, axis=0)))

    def on_page(x: float, y: float) -> tuple[float, float]:
        return scale * x, -scale * y

    circles = [_circle(path, number, pulley, scale, on_page) for number, pulley in enumerate(drive.pulleys)]
    names = [box for one in circles for box in _name_box(one)]
    corners = np.concatenate([scale * points * [1.0, -1.0], *names])
    room = _MARGIN * _PICTURE_SIZE
    left, top = (float(one) for one in corners.min(axis=0) - room)
    width, height = (float(one) for one in np.ptp(corners, axis=0) + 2.0 * room)
    moved = tuple(
        replace(one, x=one.x - left, y=one.y - top, label=(one.label[0] - left, one.label[1] - top)) for one in circles
    )

    def place(x: float, y: float) -> tuple[float, float]:
        across, down = on_page(x, y)
        return across - left, down - top

    return Picture(width, height, moved, outline(path, place, scale), path is not drive.path)


def shortened(path: Path) -> Path:
    """The path with its longest gap between pulleys cut to `_MAX_GAP`, as by break lines, and others across it."""
    radii, ends = abs(path.radii), np.empty((0, 2)) if path.ends is None else path.ends
    points, sizes = np.concatenate([path.centers, ends]), np.concatenate([radii, np.zeros(len(ends))])
    largest, diameter = np.array([_gaps(one, sizes)[1].max(initial=0.0) for one in points.T]), 2.0 * float(radii.max())
    ratio = _MAX_GAP * diameter / max(float(largest.max()), diameter)
    if ratio >= 1.0:
        return path
    limits = np.maximum(ratio * largest, diameter)
    cut = np.column_stack([_cut(one, sizes, limit) for one, limit in zip(points.T, limits.tolist(), strict=True)])
    return Path(cut[: len(radii)], path.radii, None if path.ends is None else cut[len(radii) :], path.nips)


def _gaps(middles: FloatArray, sizes: FloatArray) -> tuple[IntArray, FloatArray]:
    """Circles in the order of their lower edges, and the gap in front of each but the first, along one axis."""
    order = np.argsort(middles - sizes)
    reach = np.maximum.accumulate((middles + sizes)[order])
    return order, (middles - sizes)[order][1:] - reach[:-1]


def _cut(middles: FloatArray, sizes: FloatArray, limit: float) -> FloatArray:
    """Coordinates of circles, moved together where a gap between them is longer than a limit."""
    order, gaps = _gaps(middles, sizes)
    moved = middles.copy()
    moved[order[1:]] -= np.cumsum(np.maximum(gaps - limit, 0.0))
    return moved


def _circle(
    path: Path, number: int, pulley: Pulley, scale: float, on_page: Callable[[float, float], tuple[float, float]]
) -> Circle:
    """A pulley with its name, beyond its arc where the circle is too small."""
    (x, y), radius = on_page(*path.centers[number].tolist()), scale * pulley.radius
    right, up = path.clear_way(number) or (0.0, -1.0)
    half = _LETTER_WIDTH * len(pulley.name) / 2.0
    outside = float(half > radius - _ARC_DISTANCE)
    away = radius + _NAME_GAP + half * (abs(right) > _BESIDE_COSINE)
    return Circle(
        pulley.name,
        x,
        y,
        radius,
        pulley.prescribed,
        (x + outside * right * away, y - outside * up * (radius + 2.0 * _NAME_GAP)),
    )


def _name_box(circle: Circle) -> list[FloatArray]:
    """Two corners of the name of a pulley that stands beyond its arc; none of one within."""
    (x, y), half = circle.label, _LETTER_WIDTH * len(circle.name) / 2.0
    return [] if (x, y) == (circle.x, circle.y) else [np.array([[x - half, y - _NAME_GAP], [x + half, y + _NAME_GAP]])]


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

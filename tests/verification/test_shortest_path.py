"""The path of a belt is the shortest closed curve around its pulleys: found without any tangent."""

import math

import numpy as np
import pytest

from beltdyn.model import Path

CROSSED = ((0.0, 0.0, 0.12), (0.6, 0.0, -0.08))
THREE = ((0.0, 0.0, 0.1), (0.5, 0.05, 0.07), (0.2, 0.4, 0.05))
IDLER = ((0.0, 0.0, 0.1), (0.25, -0.05, -0.04), (0.8, 0.0, 0.2))
SERPENTINE = (
    (0.0, 0.0, 0.082),
    (0.22, -0.06, 0.062),
    (0.26, 0.16, 0.032),
    (0.11, 0.16, -0.038),
    (0.08, 0.33, 0.062),
    (-0.03, 0.17, -0.053),
    (-0.17, 0.07, 0.037),
)
LAYOUTS = pytest.mark.parametrize("circles", [THREE, IDLER, CROSSED, SERPENTINE])


def path(*circles: tuple[float, float, float]) -> Path:
    table = np.array(circles)
    return Path(table[:, :2], table[:, 2])


@pytest.mark.parametrize(
    "circles", [IDLER, *(pytest.param(one, marks=pytest.mark.slow) for one in (THREE, CROSSED, SERPENTINE))]
)
def test_a_taut_string_finds_the_path(circles: tuple[tuple[float, float, float], ...]) -> None:
    """A closed polygon that shortens while its corners stay out of the circles ends on the path.

    Corners lie on circles, and chords cut them: the polygon is shorter by R wrap (step / R)^2 / 24.
    """
    laid, corners = path(*circles), 240
    s = np.arange(corners) * laid.length / corners
    wave = 0.1 * np.abs(laid.radii).min() * np.sin(7 * 2 * np.pi * s / laid.length)
    along = laid.tangent(s)
    points = laid.position(s) + wave[:, None] * np.stack([-along[:, 1], along[:, 0]], axis=1)
    radii = np.abs(laid.radii)
    for _ in range(12_000):
        points = 0.5 * points + 0.25 * (np.roll(points, 1, axis=0) + np.roll(points, -1, axis=0))
        for center, radius in zip(laid.centers, radii, strict=True):
            arm = points - center
            distance = np.sqrt(np.einsum("ij,ij->i", arm, arm))
            inside = distance < radius
            points[inside] = center + arm[inside] * (radius / distance[inside])[:, None]
    found = float(np.sum(np.linalg.norm(np.roll(points, -1, axis=0) - points, axis=1)))
    cut = float(np.sum(laid.wrap_angles / radii)) * (laid.length / corners) ** 2 / 24
    assert found == pytest.approx(laid.length - cut, abs=cut)
    assert found > laid.length - 2 * cut


@LAYOUTS
def test_leaving_later_and_meeting_earlier_is_longer(circles: tuple[tuple[float, float, float], ...]) -> None:
    """Tangent points moved along the arcs, to where a straight line between them stays outside."""
    laid = path(*circles)
    for span in range(laid.count):
        following = (span + 1) % laid.count
        lengths = []
        for turn in (0.0, 0.02, 0.04):
            ends = []
            for pulley, end, sense in ((span, 0, 1.0), (following, 1, -1.0)):
                arm = laid.span_points[span, end] - laid.centers[pulley]
                angle = sense * np.sign(laid.radii[pulley]) * turn
                cosine, sine = math.cos(angle), math.sin(angle)
                ends.append(laid.centers[pulley] + np.array([[cosine, -sine], [sine, cosine]]) @ arm)
            arcs = turn * (abs(laid.radii[span]) + abs(laid.radii[following]))
            lengths.append(float(np.linalg.norm(ends[1] - ends[0])) + arcs)
        assert lengths[0] < lengths[1] < lengths[2]

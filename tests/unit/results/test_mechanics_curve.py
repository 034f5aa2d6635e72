import numpy as np
import pytest

from beltdyn.elements.ancf import ANCF
from beltdyn.elements.truss import TRUSS
from beltdyn.results.mechanics import centerline


def test_circle_is_missed_by_no_more_than_the_cubic_must() -> None:
    nodes, radius = 8, 0.2
    angle = 2 * np.pi * np.arange(nodes) / nodes
    normal = np.column_stack([np.cos(angle), np.sin(angle)])
    tangent = np.column_stack([-np.sin(angle), np.cos(angle)])
    lengths = np.full(nodes, 2 * np.pi * radius / nodes)
    points = centerline(ANCF, np.hstack([radius * normal, tangent, normal]), lengths)
    assert points.shape == (nodes, 17, 2)
    np.testing.assert_allclose(points[:, 0], radius * normal, atol=1e-15)
    np.testing.assert_allclose(points[:, -1], np.roll(points[:, 0], -1, axis=0), atol=1e-15)
    miss = np.abs(np.linalg.norm(points, axis=-1) - radius).max()
    assert miss == pytest.approx(radius * (np.pi / 4) ** 4 / 384, rel=0.1)


def test_links_are_straight() -> None:
    corners = np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 2.0]])
    points = centerline(TRUSS, corners, np.ones(3), points=5)
    along = np.linspace(0.0, 1.0, 5)[:, None]
    for number, start in enumerate(corners):
        end = corners[(number + 1) % 3]
        np.testing.assert_allclose(points[number], start + along * (end - start), atol=1e-15)

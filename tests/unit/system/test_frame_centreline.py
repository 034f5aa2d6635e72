"""Points anywhere along the belt, and their derivatives."""

import numpy as np
import pytest

from beltdyn.model import Drive, Path, prepare
from beltdyn.system.build import drive_system
from beltdyn.system.frame import centreline_points
from beltdyn.system.state import laid, point_coordinates


@pytest.mark.parametrize("kind", ["ancf", "quintic"])
def test_points_of_a_laid_belt(drive: Drive, kind: str) -> None:
    """At the nodes they are those of the path; between these the derivatives are those of the places."""
    system = drive_system(prepare(drive.replace(belt=drive.belt.replace(discretization=kind, elements=12))))
    path = Path(drive.path.centers, drive.path.radii)
    state = laid(system, path)
    nodes = point_coordinates(system)
    place, slope, _ = centreline_points(system, state.position, nodes)
    stretch = path.length / drive.belt_length
    np.testing.assert_allclose(place, path.position(stretch * nodes), atol=1e-12)
    np.testing.assert_allclose(slope, stretch * path.tangent(stretch * nodes), atol=1e-12)
    along, step = np.linspace(0.03, 0.9, 7) * drive.belt_length + 1e-3, 1e-6
    (before, slopes_before, _), (after, slopes_after, _) = (
        centreline_points(system, state.position, along + move) for move in (-step, step)
    )
    _, slope, bend = centreline_points(system, state.position, along)
    np.testing.assert_allclose((after - before) / (2 * step), slope, atol=1e-8)
    np.testing.assert_allclose((slopes_after - slopes_before) / (2 * step), bend, atol=1e-6 * np.abs(bend).max())

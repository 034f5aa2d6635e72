"""One belt element, and the section of the paper's belt."""

import numpy as np
import pytest

from beltdyn.arrays import FloatArray
from beltdyn.elements.kind import Section
from beltdyn.model import Drive
from beltdyn.system.state import belt_section


@pytest.fixture(scope="session")
def section(drive: Drive) -> Section:
    return belt_section(drive.belt)


@pytest.fixture(scope="session")
def length() -> float:
    return 0.06


@pytest.fixture(scope="session")
def unloaded(length: float) -> FloatArray:
    """Coordinates of a straight element along the x axis."""
    return np.array([0, 0, 1, 0, 0, 1, length, 0, 1, 0, 0, 1], dtype=float)

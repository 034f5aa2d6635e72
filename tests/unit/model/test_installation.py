from collections.abc import Callable
from math import pi, sqrt

import numpy as np
import pytest

from beltdyn.model import Drive, install, layer_lengths

MakeDrive = Callable[..., Drive]


def test_layer_lengths(drive: Drive) -> None:
    bending, sinking = layer_lengths(drive, 1600.0)
    assert bending == pytest.approx(sqrt(drive.belt.bending_stiffness / 1600.0))
    assert sinking == pytest.approx(sqrt(1600.0 / 1e7))


def test_hub_loads(make_drive: MakeDrive) -> None:
    """sqrt(T1^2 + T2^2 - 2 T1 T2 cos(wrap)), and all of them are in balance."""
    installation = install(make_drive("serpentine", length=1.8))
    tension, wraps = installation.tension, installation.path.wrap_angles
    loads_of = np.linalg.norm(installation.hub_loads, axis=1)
    np.testing.assert_allclose(loads_of, tension * np.sqrt(2 - 2 * np.cos(wraps)), rtol=1e-12)
    np.testing.assert_allclose(installation.hub_loads.sum(axis=0), 0.0, atol=1e-10)
    pulled = install(make_drive("open"))
    assert pulled.hub_loads[0, 0] > 0 > pulled.hub_loads[1, 0]


def test_span_frequency_of_a_string_and_of_a_beam(make_drive: MakeDrive) -> None:
    string = make_drive("open", bending_factor=1e-12)
    installation = install(string)
    stretch = 1 + installation.strain
    mass = string.belt.mass_per_length / stretch
    length = installation.path.span_lengths[0]
    expected = np.sqrt(installation.tension / mass) / (2 * length)
    assert installation.span_frequencies[0] == pytest.approx(expected, rel=1e-9)
    beam = make_drive("open", installed_tension=1e-3, bending_factor=1.0)
    expected = pi / (2 * length**2) * np.sqrt(beam.belt.bending_stiffness / beam.belt.mass_per_length)
    assert install(beam).span_frequencies[0] == pytest.approx(expected, rel=1e-3)

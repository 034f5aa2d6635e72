"""Surfaces of pulleys that a drive file may name."""

import pytest

from beltdyn.contact.surface import KINDS
from beltdyn.errors import ModelError
from beltdyn.model import Pulley
from beltdyn.model.pulley import surface_part


@pytest.mark.parametrize("name", KINDS)
def test_every_kind_is_a_part_with_the_parameters_of_its_kind(name: str) -> None:
    kind = KINDS[name]
    given = {parameter.name: 0.002 for parameter in kind.parameters}
    surface = surface_part(kind)(**given)
    assert surface.parameters == given
    assert surface.reach == kind.reach(given)
    with pytest.raises(ModelError, match="is not a known key"):
        surface_part(kind)(**given, width=1.0)


def test_an_eccentric_pulley_reaches_further_by_its_eccentricity() -> None:
    pulley = Pulley(
        name="driver",
        center=(0, 0),
        radius=0.1,
        inertia=1.0,
        surface={"kind": "eccentric", "eccentricity": "2 mm"},
    )
    assert pulley.surface is not None
    assert pulley.surface.reach == pytest.approx(0.002, rel=1e-15)

"""Parts: what a copy takes over, and what takes the place of what."""

import pytest
from pydantic import Field, model_validator

from beltdyn.errors import ModelError
from beltdyn.parts.part import Part


class Rod(Part):
    """A rod of a length, or of a mass; or of both, and then of another material."""

    either = ("length", "mass")

    length: float | None = Field(None, gt=0, description="the length, in m")
    mass: float | None = Field(None, gt=0, description="the mass, in kg")
    name: str = Field("rod", description="the name")

    @model_validator(mode="after")
    def _has_a_size(self) -> "Rod":
        if self.length is None and self.mass is None:
            raise ValueError("has neither length nor mass. Give one of them")
        return self


@pytest.mark.parametrize(
    ("given", "changes", "expected"),
    [
        ({"length": 2.0}, {"name": "bar"}, {"length": 2.0, "name": "bar"}),
        ({"length": 2.0}, {"length": 3.0}, {"length": 3.0}),
        ({"length": 2.0}, {"mass": 3.0}, {"mass": 3.0}),
        ({"mass": 2.0}, {"length": 3.0}, {"length": 3.0}),
        ({"length": 2.0}, {"mass": 3.0, "length": None}, {"mass": 3.0}),
        ({"length": 2.0}, {"mass": 3.0, "length": 4.0}, {"mass": 3.0, "length": 4.0}),
        ({"length": 2.0}, {"mass": None}, {"length": 2.0}),
        ({"length": 2.0, "mass": 1.0}, {"mass": 3.0}, {"length": 2.0, "mass": 3.0}),
        ({"length": 2.0, "mass": 1.0}, {"length": None}, {"mass": 1.0}),
    ],
)
def test_a_copy_is_the_part_that_is_written_so(
    given: dict[str, float], changes: dict[str, float], expected: dict[str, float]
) -> None:
    rod = Rod(**given)
    assert rod.replace(**changes) == Rod(**expected)
    assert rod == Rod(**given)


def test_a_copy_is_validated() -> None:
    rod = Rod(length=2.0)
    with pytest.raises(ModelError, match="neither length nor mass"):
        rod.replace(length=None)
    with pytest.raises(ModelError, match=r"rod\.length = -1"):
        rod.replace(length=-1.0)


def test_what_is_left_open_is_no_argument() -> None:
    assert Rod(length=2.0, mass=None).arguments == {"length": 2.0, "name": "rod"}

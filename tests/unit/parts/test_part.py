"""Parts: what a copy takes over, and what takes the place of what."""

import pytest
from pydantic import Field, ValidationError, model_validator

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


class Bar(Part):
    """A part whose spring has another name in the file."""

    length: float = Field(gt=0, description="the length, in m")
    spring: float | None = Field(None, alias="k", description="the rate, in N/m")


class OtherBar(Bar):
    """The same under another name."""


def test_a_part_cannot_be_changed() -> None:
    with pytest.raises(ValidationError, match="frozen"):
        Bar(length=1.0).length = 2.0  # type: ignore[misc]


def test_arguments_are_named_as_in_the_file_and_make_the_part_again() -> None:
    bar = Bar(length=1.0, k=3.0)
    assert bar.arguments == {"length": 1.0, "k": 3.0}
    assert Bar(**bar.arguments) == bar
    assert (bar.replace(length=2.0).spring, bar.length) == (3.0, 1.0)


def test_none_leaves_open_only_what_may_be_left_open() -> None:
    assert Bar(length=1.0, k=None) == Bar(length=1.0)
    with pytest.raises(ModelError, match=r"bar\.length = null must be a number"):
        Bar(length=None)


def test_a_key_that_is_not_known_is_refused() -> None:
    with pytest.raises(ModelError, match=r"bar\.width is not a known key"):
        Bar(length=1.0, width=2.0)  # type: ignore[call-arg]


def test_parts_are_the_same_if_their_kind_and_their_arguments_are() -> None:
    assert Bar(length=1.0) == Bar(length=1.0)
    assert Bar(length=1.0) != Bar(length=2.0)
    assert Bar(length=1.0) != OtherBar(length=1.0)
    assert Bar(length=1.0) != {"length": 1.0}


def test_help_tells_of_every_argument() -> None:
    assert Bar.__doc__ is not None
    assert "The rate, in N/m" in Bar.__doc__
    assert list(Bar.__signature__.parameters) == ["length", "k"]

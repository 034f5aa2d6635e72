"""Example drives by name."""

import pytest

from beltdyn.errors import ModelError
from beltdyn.model.toml import example, example_texts


@pytest.mark.parametrize("name", example_texts())
def test_an_example_keeps_its_text(name: str) -> None:
    assert example(name).text == example_texts()[name]


def test_hyphens_and_suffix_are_accepted() -> None:
    assert example("two-pulley.toml") == example("two_pulley")


def test_an_unknown_example_lists_those_there_are() -> None:
    with pytest.raises(
        ModelError, match=r"'nothing' does not exist\. Choose one of accessory_drive, .*washing_machine"
    ):
        example("nothing")

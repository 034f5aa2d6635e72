"""A finding has three sentences."""

from typing import Any

import pytest

from beltdyn.parts.messages import Finding, listing


def test_it_says_what_is_wrong_what_that_spoils_and_what_to_do() -> None:
    finding = Finding("the belt is slack.", "Tensions are wrong by 3 N.", "Shorten the belt.")
    assert str(finding) == "the belt is slack. Tensions are wrong by 3 N. Shorten the belt."


@pytest.mark.parametrize("part", ["fault", "spoils", "remedy"])
@pytest.mark.parametrize("words", ["", "no sentence"])
def test_no_part_may_be_left_out(part: str, words: str) -> None:
    sentences: dict[str, Any] = {"fault": "It is slack.", "spoils": "Tensions.", "remedy": "Shorten it."}
    with pytest.raises(ValueError, match="part of a finding"):
        Finding(**sentences | {part: words})


def test_listing() -> None:
    assert [listing("a"), listing("ab"), listing("abc")] == ["a", "a and b", "a, b and c"]

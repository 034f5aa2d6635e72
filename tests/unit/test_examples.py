"""The examples that come with the package: each can be written, is valid, and warns of what its page explains."""

import re
from importlib.resources import files
from pathlib import Path

import pytest

from beltdyn.model import advise, dumps, install, loads

ROOT = Path(__file__).parents[2]
EXAMPLES = {
    file.name.removesuffix(".toml"): file.read_text(encoding="utf-8")
    for file in files("beltdyn").joinpath("examples").iterdir()
}
EXPECTED = {
    "timing_drive": ["few teeth are in mesh: 4.3 on water pump."],
    "two_pulley": [
        "the contact between belt and pulleys is so soft that it reduces the belt tension by 5.8%",
        "contact.damping = 10 N s/m^2 is 0.5% of critical",
        "contact.creep_rate_factor = 1e+05: friction builds up 7 times more slowly",
        "the belt has too few elements for peak pressure (over 100%), mean pressure",
    ],
}
"""How the warnings of `check` begin; an example that is not named here has none."""


@pytest.mark.parametrize("name", EXAMPLES)
def test_warnings_are_those_that_the_page_explains(name: str) -> None:
    drive = loads(EXAMPLES[name])
    expected = EXPECTED.get(name, [])
    found = advise(drive, install(drive))
    assert [text[: len(start)] for text, start in zip(found, expected, strict=True)] == expected


@pytest.mark.parametrize("name", EXAMPLES)
def test_what_the_writer_writes_of_it_is_the_same_drive(name: str) -> None:
    drive = loads(EXAMPLES[name])
    assert loads(dumps(drive)) == drive


@pytest.mark.parametrize("name", EXAMPLES)
def test_it_says_what_it_is(name: str) -> None:
    """A title, and a comment with most groups."""
    text = EXAMPLES[name]
    assert text.startswith("# ")
    assert text.count("#") >= text.count("\n[")


def test_every_example_has_a_page_with_its_file_and_pictures() -> None:
    index = (ROOT / "docs" / "examples" / "index.md").read_text(encoding="utf-8")
    pages = {page.stem: page.read_text("utf-8") for page in (ROOT / "docs" / "examples").glob("*.md")}
    for name in EXAMPLES:
        (own,) = (one for one, text in pages.items() if f"src/beltdyn/examples/{name}.toml" in text)
        pictures = re.findall(r"\(\.\./_static/examples/(.*?)\)", pages[own])
        assert f"{name}_layout.png" in pictures
        assert all((ROOT / "docs" / "_static" / "examples" / picture).is_file() for picture in pictures)
        assert f"\n{own}\n" in index
        assert f"_static/examples/{name}_layout.png" in index

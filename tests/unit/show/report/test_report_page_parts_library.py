"""The library inside the page."""

import json

from beltdyn.show.report.report import embedded, library


def test_the_library_is_one_script() -> None:
    assert len(library()) < 2_000_000
    assert "</script" not in library()


def test_no_text_ends_the_script_that_holds_it() -> None:
    text = embedded({"a": {"name": "</script><b>"}})
    assert "<" not in text
    assert json.loads(text) == {"a": {"name": "</script><b>"}}

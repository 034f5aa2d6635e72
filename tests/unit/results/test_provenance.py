"""Where a result comes from is written into it."""

import platform
from datetime import UTC, datetime, timedelta
from importlib.metadata import version

import numpy as np

from beltdyn.analyses import RUN
from beltdyn.results import provenance
from beltdyn.results.schema import FORMAT


def test_a_result_names_its_drive_and_what_computed_it() -> None:
    found = provenance("[belt]", "Two pulleys")
    assert (found["title"], found["drive"], found["kind"]) == ("Two pulleys", "[belt]", RUN)
    assert found["format"] == f"{FORMAT[0]}.{FORMAT[1]}"
    assert (found["numpy_version"], found["beltdyn_version"]) == (np.__version__, version("beltdyn"))
    assert found["python_version"] == platform.python_version()


def test_the_hour_is_that_of_greenwich() -> None:
    created = datetime.fromisoformat(provenance("", "")["created"])
    assert created.utcoffset() == timedelta(0)
    assert timedelta(seconds=-1) <= datetime.now(UTC) - created < timedelta(minutes=1)


def test_a_result_of_another_analysis_says_so() -> None:
    assert provenance("", "", "modes")["kind"] == "modes"

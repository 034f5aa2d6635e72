"""Where a result comes from is written into it."""

import platform
from datetime import UTC, datetime, timedelta
from importlib.metadata import version

import numpy as np
import pytest

from beltdyn.analyses import ANALYSES, RUN
from beltdyn.model import Drive
from beltdyn.results import build_result, provenance
from beltdyn.results.provenance import STAYING, mesh_facts, mesh_used
from beltdyn.results.schema import FORMAT
from beltdyn.show.sheet import sheet
from beltdyn.show.tables import Facts


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


@pytest.mark.parametrize("kind", [one.name for one in ANALYSES.values() if one.stays])
@pytest.mark.parametrize("points", [None, 3])
def test_analyses_on_a_mesh_that_stays_say_what_they_do_not_use(drive: Drive, kind: str, points: int | None) -> None:
    given = drive if points is None else drive.with_({"belt.quadrature_points": points})
    result = build_result(kind, given, {}, {})
    unused = "" if points is None else f"belt.quadrature_points = {points}"
    said = result.dataset.attrs
    assert (said["mesh_frame"], said["mesh_element"], said["mesh_unused"]) == ("staying", "quintic", unused)
    facts = mesh_facts(said)
    assert [name for name, _ in facts] == (["mesh", "not used"] if unused else ["mesh"])
    told = [fact for part in sheet(result).parts if isinstance(part, Facts) for fact in part.facts]
    assert set(facts) <= set(told)


def test_elements_are_counted_where_there_is_one_mesh(drive: Drive) -> None:
    assert mesh_facts(mesh_used(drive, drive.frame, 20)) == [("mesh", "20 ancf elements, travelling, as given")]
    assert "mesh_elements" not in mesh_used(drive, STAYING)
    assert mesh_facts({}) == []

import re
from collections.abc import Mapping
from pathlib import Path
from types import ModuleType

import pytest

from beltdyn.errors import ModelError
from beltdyn.model import Drive
from validation.paper import build_paper
from validation.paper.build import _timed
from validation.paper.runs import RunMissingError, Runs
from validation.paper.statement import Finding, Section, Statement, Verdict
from validation.paper.statements import SECTIONS
from validation.published import two_pulley


def part(name: str, drives: Mapping[str, Drive], fails: bool = False) -> ModuleType:
    """A part of a page, as a module is one."""
    module = ModuleType(f"somewhere.{name}")

    def section(_: Runs) -> Section:
        if fails:
            raise RunMissingError("the run x failed: why")
        statement = Statement(name, name, "words", 250, "none", [Finding("as published", [], Verdict.OPEN)])
        return Section(name, name, "Introduction.", [statement])

    vars(module).update(cases=lambda: drives, section=section)
    return module


def test_a_part_whose_run_failed_is_said_to_be_missing(tmp_path: Path) -> None:
    outcome = build_paper(tmp_path, parts=[part("one", {}), part("two_three", {}, fails=True)])
    text = outcome.page.read_text(encoding="utf-8")
    assert [section.name for section in outcome.sections] == ["one", "two-three"]
    assert "This part could not be made: the run x failed: why" in text


def test_two_parts_may_not_use_a_name_for_two_drives(tmp_path: Path) -> None:
    with pytest.raises(ValueError, match="different drives drive"):
        build_paper(tmp_path, parts=[part("one", {"drive": two_pulley()}), part("two", {"drive": two_pulley(30)})])


def test_a_file_in_place_of_the_folder(tmp_path: Path) -> None:
    file = tmp_path / "file"
    file.touch()
    with pytest.raises(ModelError, match=r"the folder .* cannot be created"):
        build_paper(file, parts=[])


def test_all_cases_can_be_built_and_have_names_fit_for_files() -> None:
    names = [name for part in SECTIONS for name in part.cases()]
    assert all(re.fullmatch(r"[\w-]+", name) for name in names)


def test_runs_that_several_parts_time_are_timed_once(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """A part that lacks a run is left out, and does not keep others from theirs."""
    parts = [part(name, {}) for name in ("one", "two", "three")]
    vars(parts[0])["timed"] = lambda _: ["a", "b"]
    vars(parts[1])["timed"] = lambda runs: [runs["missing"]]
    vars(parts[2])["timed"] = lambda _: ["b", "c"]
    runs = Runs({}, {}, {"missing": "why"}, {"c": "a"})
    assert _timed(parts, runs) == ["a", "b"]

"""A small part of the campaign of wrong, odd, damaged and hostile input; `python -m tools.campaign` has it whole.

BELTDYN_MUTATIONS says how many wrong drive files are checked in the slow part (a fifth of them is brought to rest,
too), and BELTDYN_FIRST_MUTATION the first seed.
"""

import contextlib
import os
import sys
from collections.abc import Callable
from functools import partial
from pathlib import Path

import pytest

import beltdyn as bd
from beltdyn.cli.app import app
from beltdyn.errors import BeltdynError, ModelError
from beltdyn.model import Drive, loads
from tools.campaign import damage, hostile
from tools.campaign.__main__ import examples, odd, report
from tools.campaign.crossed_examples import _computed, crossed
from tools.campaign.crossing import CONSUMERS, OF_RUNS, pair, with_gaps
from tools.campaign.drive_mutations import bases
from tools.campaign.mutants import balance, look, try_mutant
from tools.campaign.odd_drives import odd_drive
from tools.campaign.trial import attempt, attempt_here, outcome

FIRST = int(os.environ.get("BELTDYN_FIRST_MUTATION", "0"))
COUNT = int(os.environ.get("BELTDYN_MUTATIONS", "1000"))
LARGEST = 1_000_000
"""Growth of the memory of the process over all files, kB."""

pytestmark = [
    pytest.mark.filterwarnings("default"),
    pytest.mark.skipif(not hasattr(os, "fork"), reason="a trial is a copy of the process"),
]


def peak_memory() -> int:
    """Largest memory of this process so far, kB; 0 where that is not known."""
    if sys.platform != "linux":
        return 0
    import resource

    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss


def test_what_comes_of_trials() -> None:
    def refuse() -> str:
        raise ModelError("no")

    def fail() -> str:
        raise KeyError("x")

    kinds = [attempt(work, 5.0).kind for work in (str, refuse, fail, lambda: "changed", partial(os._exit, 3))]
    assert kinds == ["fine", "refused", "traceback", "fault", "died"]
    assert attempt(lambda: "x" * sum(iter(int, 1)), 1.0).kind == "too long"
    assert outcome(partial(sys.exit, 1)) == ("fault", "exit code 1")


def test_some_wrong_drive_files(tmp_path: Path) -> None:
    originals = bases()
    found = {seed: try_mutant(seed, originals, tmp_path) for seed in range(100)}
    assert {seed: one for seed, one in found.items() if one.kind not in ("fine", "refused")} == {}


def test_odd_drives_at_rest_by_closed_forms() -> None:
    """Slack, sunk in, too stiff to bend, with negative tensions: shown, or refused with a message."""
    known = {seed: attempt(partial(_looked_at, seed), 10.0) for seed in range(150)}
    assert {seed: one for seed, one in known.items() if one.kind not in ("fine", "refused")} == {}
    assert sum(one.kind == "fine" for one in known.values()) > 40


def _looked_at(seed: int) -> str:
    look(odd_drive(seed))
    return ""


@pytest.mark.slow
@pytest.mark.parametrize(("use", "count"), [(look, COUNT), (balance, COUNT // 5)], ids=["check", "static"])
def test_many_wrong_drive_files(tmp_path: Path, use: Callable[[Drive], None], count: int) -> None:
    originals = bases()
    for original in originals:  # kernels are compiled before the clock of a file starts
        with contextlib.suppress(BeltdynError):  # the coarse mesh is too coarse for some
            balance(loads(original))
    memory = peak_memory()
    found = {seed: try_mutant(seed, originals, tmp_path, use) for seed in range(FIRST, FIRST + count)}
    assert {seed: one for seed, one in found.items() if one.kind not in ("fine", "refused")} == {}
    assert peak_memory() - memory < LARGEST


def test_every_command_exists(tmp_path: Path) -> None:
    """An unknown command would be refused whatever its file."""
    cases = list(hostile.cases(b"beltdyn checkpoint\n"))
    for number in range(len(cases)):
        (tmp_path / str(number)).mkdir()
    words = {words_of(tmp_path / str(number))[0] for number, (_, words_of) in enumerate(cases)}
    assert words <= set(app)


def test_every_consumer_reads_a_drive_at_rest(tmp_path: Path) -> None:
    """Or refuses it with the reason; the slow test has all results."""
    rest = bd.open_result(bd.equilibrium(bd.example("two_pulley")).save(tmp_path / "rest.nc"))
    consumers = {name: use for name, use in CONSUMERS.items() if name != "analyses of results"}
    ends = {name: outcome(partial(use, rest, tmp_path)) for name, use in consumers.items()}
    assert {name: end for name, end in ends.items() if end[0] not in ("fine", "refused")} == {}
    assert {name for name, end in ends.items() if end[0] == "refused"} == {"export to vtk"}
    assert outcome(partial(pair, [rest, rest], tmp_path)) == ("fine", "")


def test_faults_of_consumers_are_noticed(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Of commands, of warnings, and of trials in this process that take too long."""
    rest = bd.open_result(bd.equilibrium(bd.example("two_pulley")).save(tmp_path / "rest.nc"))
    monkeypatch.setattr("tools.campaign.crossing.run_command", lambda words: 5 * (words[0] == "export"))
    assert CONSUMERS["commands"](rest, tmp_path) == "plot: exit code 0, and no word; export: exit code 5: "
    assert attempt_here(lambda: "x" * next(one for one in iter(int, 1) if one), 0.2).kind == "too long"
    told = rest.dataset.assign_attrs(warnings="no derivative: internal error in a.py:1 (KeyError: 'a').")
    assert "internal error in a.py:1" in _computed(lambda: bd.Result(told, rest.drive))


def test_gaps_without_a_word_are_noticed(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """A panel without values, a number that is none, and an exception that no refusal is."""
    found = bd.tensioner_sheet(bd.example("alternator_drive"), tolerance="1 mm", wear="2 mm")
    assert found.dataset["failure"].dims == ("state",)
    lost = next(
        one for one in (with_gaps(found, seed) for seed in range(99)) if one and (one.dataset.failure != "").all()
    )
    assert CONSUMERS["every figure"](lost, tmp_path) == ""
    monkeypatch.setattr("beltdyn.show.plot.figures.explain_empty", lambda *_: None)
    assert "panels are empty without a word" in CONSUMERS["every figure"](lost, tmp_path)
    monkeypatch.setattr("tools.campaign.crossing.as_text", lambda _: "rating used: nan%")
    assert CONSUMERS["sheet"](found, tmp_path) == "says 'rating used: nan%'"
    monkeypatch.setitem(OF_RUNS, "summarize", lambda run: {}[run])
    assert "summarize: KeyError" in CONSUMERS["derived quantities"](found, tmp_path)


@pytest.mark.slow
@pytest.mark.parametrize("name", examples("all"))
def test_every_consumer_reads_every_result(name: str, tmp_path: Path) -> None:
    """Studies are of other analyses with each example."""
    assert report(name, crossed(1 + examples("all").index(name), [name], tmp_path)) == 0


@pytest.mark.slow
def test_odd_drives(tmp_path: Path) -> None:
    assert report("odd drives", odd(3, 34, tmp_path)) == 0


def test_code_in_files_is_not_run(tmp_path: Path) -> None:
    """And the trial notices code that is."""
    cases = [case for case in hostile.cases(b"beltdyn checkpoint\n") if "pickle" in case[0] or "dotted" in case[0]]
    for number, case in enumerate(cases):
        folder = tmp_path / str(number)
        folder.mkdir()
        assert attempt(partial(hostile.give, case, folder), 10.0).kind == "refused"
        case[1](folder)
    assert len(cases) == 3
    (tmp_path / hostile.MARKER).touch()
    assert attempt(partial(hostile.give, ("none", lambda _: ["schema"]), tmp_path), 10.0).kind == "traceback"


def test_damage_is_noticed_by_the_trial(tmp_path: Path) -> None:
    """A file whose bytes are what is read has no damage that changes nothing."""
    kind = damage.Kind("plain", tmp_path / "plain", lambda path: path.read_bytes().hex())
    for seed in range(20):
        kind.path.write_bytes(bytes(range(256)) * 8)
        intact = kind.read(kind.path)
        fault = damage.silent(kind, seed, intact, tmp_path)
        assert (fault == "") == (kind.read(kind.path) == intact)

"""The paper: every statement on the page of `make paper` keeps the verdict that the project claims.

The paper shows curves and no table.  Numbers beside its statements come from an independent implementation of the same
equations: ripple at 8.5 Hz, root mean square error of the driven speed against a mesh of 240 elements 0.09 rad/s with
20 elements and 0.03 rad/s with 30.
"""

import pytest

from validation.paper import Outcome, build_paper
from validation.paper.statement import Finding, Statement, Verdict

HOLDS, FAILS, OPEN = Verdict.HOLDS, Verdict.FAILS, Verdict.OPEN

CLAIMED = {
    "rigid-motion": (HOLDS, HOLDS),
    "constant-mass-matrix": (HOLDS, HOLDS),
    "no-shear-or-poisson-locking": (HOLDS, HOLDS),
    "factors-act-linearly": (HOLDS, HOLDS),
    "four-elements-make-a-circle": (FAILS, HOLDS),
    "coulomb-is-costlier": (HOLDS, HOLDS),
    "slip-and-stick-within-an-element": (HOLDS, HOLDS),
    "any-standard-integrator": (HOLDS, HOLDS),
    "fewer-elements-with-unequal-pulleys": (HOLDS, HOLDS),
    "tri-linear-friction": (HOLDS, HOLDS),
    "released-belt-unknowns": (HOLDS, HOLDS),
    "initial-configuration": (HOLDS, HOLDS),
    "perfect-circle": (HOLDS, HOLDS),
    "iterations": (OPEN, OPEN),
    "practically-equal": (HOLDS, HOLDS),
    "speed-converged": (HOLDS, HOLDS),
    "tension-converged": (FAILS, FAILS),
    "unknowns": (HOLDS, HOLDS),
    "half-pulley": (HOLDS, HOLDS),
    "half-pulley-loaded": (HOLDS, HOLDS),
    "initial-normal-force": (HOLDS, HOLDS),
    "stiffness-reduces-ripple": (HOLDS, HOLDS),
    "torsional-frequency": (FAILS, HOLDS),
    "low-factor-delays": (HOLDS, HOLDS),
    "high-factor-reduces-slip": (HOLDS, HOLDS),
    "high-factor-more-accurate": (OPEN, OPEN),
    "too-low-a-factor": (HOLDS, HOLDS),
    "low-factor-is-cheaper": (HOLDS, HOLDS),
    "steady-at-one-second": (HOLDS, HOLDS),
    "linear-with-low-factor": (OPEN, HOLDS),
    "except-driver-friction": (OPEN, FAILS),
    "nonlinear-with-high-factor": (OPEN, HOLDS),
    "driver-peaks": (HOLDS, HOLDS),
    "peaks-emphasised": (HOLDS, HOLDS),
    "driven-peaks": (HOLDS, HOLDS),
    "like-leamy-and-wasfy": (OPEN, OPEN),
    "identical-forces": (FAILS, OPEN),
    "identical-speeds": (HOLDS, HOLDS),
    "quotient-of-speeds": (HOLDS, HOLDS),
    "more-than-two-pulleys": (HOLDS, HOLDS),
    "creep-under-load": (HOLDS, HOLDS),
    "leamy-and-wasfy-agree": (HOLDS, HOLDS),
    "fewer-unknowns-speed": (FAILS, FAILS),
    "fewer-unknowns-tension": (HOLDS, HOLDS),
    "fewer-unknowns-normal": (FAILS, OPEN),
    "as-accurate-as-leamy-and-wasfy": (FAILS, FAILS),
    "distributed-contact": (OPEN, HOLDS),
    "even-forces": (FAILS, HOLDS),
    "little-bending-stiffness": (HOLDS, HOLDS),
    "belt-like-element-saves-unknowns": (FAILS, FAILS),
    "multipliers-same-motion": (HOLDS, HOLDS),
    "multipliers-no-excessive-effort": (HOLDS, HOLDS),
    "energy-closes": (HOLDS, HOLDS),
}
"""Name of a statement -> its verdict with published and with the best settings on the page."""

TIMED = {"less-time"}
"""Statements about computing time, whose verdict depends on what else the machine does."""

OURS = {
    "tension-converged",
    "torsional-frequency",
    "creep-under-load",
    "even-forces",
    "as-accurate-as-leamy-and-wasfy",
    "less-time",
    "belt-like-element-saves-unknowns",
    "energy-closes",
}
"""What no words of the paper claim."""

MEGABYTE = 1_000_000


@pytest.fixture(scope="session")
def outcome(tmp_path_factory: pytest.TempPathFactory) -> Outcome:
    """The whole page, made once."""
    return build_paper(tmp_path_factory.mktemp("paper"))


@pytest.fixture(scope="session")
def statements(outcome: Outcome) -> dict[str, Statement]:
    return {statement.name: statement for section in outcome.sections for statement in section.statements}


def number(finding: Finding, name: str) -> float:
    (value,) = (number.value for number in finding.numbers if number.name == name)
    assert isinstance(value, float)
    return value


def test_every_run_is_completed(outcome: Outcome) -> None:
    assert outcome.failures == {}


def test_the_page_is_small_enough_to_send(outcome: Outcome) -> None:
    assert outcome.page.stat().st_size < 5 * MEGABYTE


def test_the_folder_is_small_enough_to_keep(outcome: Outcome) -> None:
    runs = outcome.page.parent / "runs"
    assert sum(file.stat().st_size for file in runs.iterdir()) < 100 * MEGABYTE
    drives, kept = ({file.stem for file in runs.glob(f"*.{suffix}")} for suffix in ("toml", "nc"))
    assert drives == kept


def test_checks_of_our_own_are_marked(statements: dict[str, Statement]) -> None:
    assert {name for name, statement in statements.items() if statement.ours} == OURS
    assert all((statement.page is None) == statement.ours for statement in statements.values())


def test_every_statement_has_a_claim(statements: dict[str, Statement]) -> None:
    assert statements.keys() == CLAIMED.keys() | TIMED


@pytest.mark.parametrize("name", CLAIMED)
def test_verdict(statements: dict[str, Statement], name: str) -> None:
    statement = statements[name]
    assert (statement.verdict, statement.findings[-1].verdict) == CLAIMED[name]


def test_ripple_frequency_is_that_of_the_independent_implementation(statements: dict[str, Statement]) -> None:
    """Read from a figure with 0.1 Hz; coarse meshes swing slower, by up to a tenth."""
    published, better = statements["torsional-frequency"].findings
    assert number(better, "E = 10⁸ Pa: measured") == pytest.approx(8.5, abs=0.1)
    assert number(published, "E = 10⁸ Pa: measured") == pytest.approx(8.5, rel=0.1)


@pytest.mark.parametrize(("elements", "error"), [(20, 0.09), (30, 0.03)])
def test_mesh_error_is_that_of_the_independent_implementation(
    statements: dict[str, Statement], elements: int, error: float
) -> None:
    published = statements["speed-converged"].findings[0]
    assert number(published, f"{elements} elements, rms error") == pytest.approx(error, abs=0.01)

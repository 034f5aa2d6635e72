"""What is said of errors that nobody has thought of."""

from collections.abc import Callable
from pathlib import Path
from xml.etree import ElementTree

import pytest

from beltdyn.errors import (
    TRACEBACKS,
    ConvergenceError,
    InternalError,
    ModelError,
    Parts,
    SimulationError,
    cause_of,
    classified,
    is_internal,
)
from beltdyn.parts import quantity
from beltdyn.results.damage import rainflow


def caught(action: Callable[[], object]) -> Exception:
    try:
        action()
    except Exception as error:
        return error
    raise AssertionError("nothing was raised")


@pytest.mark.provokes_internal_errors
def test_a_fault_of_beltdyn_names_its_place_and_what_repeats_it(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv(TRACEBACKS, str(tmp_path / "tracebacks.txt"))
    error = caught(lambda: rainflow(None))  # type: ignore[arg-type]
    told = classified(error, "bd.rainflow(None)")
    assert isinstance(told, InternalError)
    assert told.exit_code == 5
    line = error.__traceback__.tb_next.tb_next.tb_next.tb_lineno  # type: ignore[union-attr]
    assert str(told).startswith(f"internal error in results/damage.py:{line} ({type(error).__name__}: ")
    assert str(told).endswith(": bd.rainflow(None)")
    assert "\n" not in str(told)
    assert is_internal(f"at point 1: {told}")
    text = (tmp_path / "tracebacks.txt").read_text(encoding="utf-8")
    assert text.startswith("Traceback (most recent call last):")
    assert "in rainflow" in text


@pytest.mark.provokes_internal_errors
def test_libraries_raise_for_those_who_call_them() -> None:
    """The place is where beltdyn calls a library, not inside of it."""
    error = caught(lambda: quantity.to_si("1 mm", object()))  # type: ignore[arg-type]
    assert "in parts/quantity.py:" in cause_of(error)


def test_code_of_the_user_is_no_fault_of_beltdyn() -> None:
    def law(_: object) -> float:
        return 1.0 / 0.0

    told = classified(caught(lambda: ElementTree.fromstring("<a/>").iter(law(0))))  # type: ignore[arg-type]
    assert type(told) is SimulationError
    assert f"{Path(__file__)}:" in str(told)
    assert not is_internal(str(told))


@pytest.mark.parametrize("error", [ModelError("no."), ConvergenceError("none.")])
def test_errors_on_purpose_stay_as_they_are(error: Exception) -> None:
    assert classified(error, "repeat") is error
    assert cause_of(error) == str(error)


def test_a_full_disk_is_no_fault_of_beltdyn() -> None:
    told = classified(caught(lambda: Path("/no/such/file").stat()))
    assert type(told) is SimulationError
    assert "No such file" in str(told)


def test_parts_are_done_whatever_becomes_of_the_others() -> None:
    """And the gravest error gives the exit code; a refusal of the first is that of the whole."""

    def parts_of(*errors: Exception | None, refuses: bool = False) -> None:
        with Parts(refuses=refuses) as parts:
            for number, error in enumerate(errors):
                with parts.part("repeat"):
                    if error is not None:
                        raise error
                    parts.completed.append(number)

    parts_of(None, None)
    told = caught(lambda: parts_of(None, ModelError("no"), SimulationError("stop"), None))
    assert isinstance(told, SimulationError)
    assert (str(told), told.completed) == ("no\nstop", (0, 3))
    refused = caught(lambda: parts_of(ModelError("no"), None, refuses=True))
    assert isinstance(refused, ModelError)
    assert refused.completed == ()
    assert caught(lambda: parts_of(None, ModelError("no"), None, refuses=True)).completed == (0, 2)  # type: ignore
    whole = caught(lambda: parts_of(ConvergenceError("far"), None))
    assert type(whole) is ConvergenceError

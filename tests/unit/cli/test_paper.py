from collections.abc import Callable
from pathlib import Path
from types import SimpleNamespace

import pytest

RunMain = Callable[[list[str]], tuple[int, str, str]]


def test_an_output_folder_that_is_a_file(refuse: Callable[[list[str]], str], tmp_path: Path) -> None:
    file = tmp_path / "file"
    file.touch()
    assert "cannot be made" in refuse(["paper", "--out", str(file)])


@pytest.mark.parametrize(("failures", "code"), [({}, 0), ({"run_1": "no convergence"}, 3)])
def test_the_page_is_named_and_failures_too(
    run_main: RunMain, monkeypatch: pytest.MonkeyPatch, tmp_path: Path, failures: dict[str, str], code: int
) -> None:
    outcome = SimpleNamespace(page=tmp_path / "paper.html", failures=failures)
    monkeypatch.setattr("beltdyn.paper.build_paper", lambda *_: outcome)
    found, output, message = run_main(["paper", "--out", str(tmp_path)])
    assert found == code
    assert f"Page: {tmp_path / 'paper.html'}" in output
    assert all(f"the run {name} failed: {reason}" in message for name, reason in failures.items())


def test_an_interruption(run_main: RunMain, monkeypatch: pytest.MonkeyPatch) -> None:
    def interrupt(*_: object) -> None:
        raise KeyboardInterrupt

    monkeypatch.setattr("beltdyn.paper.build_paper", interrupt)
    assert run_main(["paper"])[0] == 130

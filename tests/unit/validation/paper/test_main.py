from pathlib import Path
from types import SimpleNamespace

import pytest

import validation.paper.__main__ as command


def test_an_output_folder_that_is_a_file(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    file = tmp_path / "file"
    file.touch()
    assert command.main(["--out", str(file)]) == 2
    assert "cannot be created" in capsys.readouterr().err


@pytest.mark.parametrize(("failures", "code"), [({}, 0), ({"run_1": "no convergence"}, 3)])
def test_the_page_is_named_and_failures_too(
    capsys: pytest.CaptureFixture[str],
    monkeypatch: pytest.MonkeyPatch,
    tmp_path: Path,
    failures: dict[str, str],
    code: int,
) -> None:
    outcome = SimpleNamespace(page=tmp_path / "paper.html", failures=failures)
    monkeypatch.setattr(command, "build_paper", lambda *_: outcome)
    assert command.main(["--out", str(tmp_path)]) == code
    shown = capsys.readouterr()
    assert str(tmp_path / "paper.html") in shown.out.replace("\n", "")
    assert all(f"the run {name} failed: {reason}" in shown.err for name, reason in failures.items())


def test_an_interruption(monkeypatch: pytest.MonkeyPatch) -> None:
    def interrupt(*_: object) -> None:
        raise KeyboardInterrupt

    monkeypatch.setattr(command, "build_paper", interrupt)
    assert command.main([]) == 130

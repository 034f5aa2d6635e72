"""The command line, run in this process."""

from collections.abc import Callable

import pytest

from beltdyn.cli import main


@pytest.fixture
def run_main(capsys: pytest.CaptureFixture[str]) -> Callable[[list[str]], tuple[int, str, str]]:
    """Run a command: exit code, standard output and standard error."""

    def run(arguments: list[str]) -> tuple[int, str, str]:
        with pytest.raises(SystemExit) as stop:
            main(arguments)
        captured = capsys.readouterr()
        assert isinstance(stop.value.code, int)
        return stop.value.code, captured.out, captured.err

    return run


@pytest.fixture
def refuse(run_main: Callable[[list[str]], tuple[int, str, str]]) -> Callable[[list[str]], str]:
    """Run a command on bad input: the message."""

    def run(arguments: list[str]) -> str:
        code, output, message = run_main(arguments)
        assert code == 2
        assert output == ""
        assert "Traceback" not in message
        return message

    return run

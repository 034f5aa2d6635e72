"""Mutation testing: what is changed, what is left alone, and that the tool notices when it does not work."""

import math
import os
import subprocess
import sys
from argparse import Namespace
from functools import partial
from pathlib import Path
from types import FunctionType

import pytest

from tools.mutation.__main__ import _Trials
from tools.mutation.mutants import control, mutants_of
from tools.mutation.traces import Trace
from tools.mutation.trial import ROOT, attempt_at_import, compiled, fits, fork, functions_of, replacements

LAW = "src/beltdyn/theory/creep.py"


def changes(folder: Path, text: str) -> list[str]:
    file = folder / "law.py"
    file.write_text(text, encoding="utf-8")
    return [f"{mutant.before} -> {mutant.after}" for mutant, _ in mutants_of(file, folder)]


def test_signs_factors_comparisons_and_calls_are_changed(tmp_path: Path) -> None:
    text = "def law(x):\n    note(x)\n    return 3.0 * x if x + 1 > y else -x\n"
    assert changes(tmp_path, text) == [
        "note(x) -> pass",
        "x + 1 > y -> x + 1 >= y",
        "x + 1 > y -> x + 1 <= y",
        "x + 1 -> x - 1",
        "1 -> 2",
        "3.0 * x -> 3.0 / x",
        "3.0 -> 6.0",
        "-x -> x",
    ]


@pytest.mark.parametrize(
    ("kernels", "text", "number"),
    [
        ("", "assert x > 1\n", 0),
        ("", "zip(a, b, strict=True)\n", 1),
        ("", "x = 1e-12\n", 0),
        ("", "y = x > 0.5\n", 2),
        ("", "y = x > 0.0\n", 3),
        ("from beltdyn.kernel import interpreted\n", "y = x > 0.0\n", 3),
        ("@kernel\ndef law(x):\n    return x\n", "y = x > 0.0\n", 2),
    ],
    ids=["assertion", "strict", "guard", "decimal", "setting", "no kernel", "continuous"],
)
def test_what_has_no_effect_is_left_alone(tmp_path: Path, kernels: str, text: str, number: int) -> None:
    """A call is dropped, a comparison turned around; its boundary stays where laws are continuous."""
    assert len(changes(tmp_path, kernels + text)) == number


def test_every_change_alters_a_function_that_is_imported() -> None:
    """In a session that has frozen its objects, as that of the tests has; of another file none."""
    mutants = [mutant for mutant, _ in mutants_of(ROOT / LAW, ROOT) if not mutant.at_import]
    elsewhere = [each for each in (changes, tried) if isinstance(each, FunctionType)]
    assert mutants
    assert elsewhere

    def work() -> int:
        functions = functions_of([LAW])[LAW]
        altered = [len(replacements(LAW, code, functions)) for _, code in compiled(mutants)]
        others = [replacements(LAW, code, elsewhere) for _, code in compiled(mutants)]
        return int(0 in altered or any(others))

    _, status = os.waitpid(fork(work, math.inf), 0)  # caches of the package are cleared
    assert os.waitstatus_to_exitcode(status) == 0


def test_what_changes_a_closure_fits_into_no_function() -> None:
    """A call of `super` that is dropped; such mutants are tried in modules that are imported anew."""
    file = "src/beltdyn/designs/found_state.py"
    mutants = [
        mutant for mutant, _ in mutants_of(ROOT / file, ROOT) if mutant.before.startswith(("super()", "count *="))
    ]
    dropped = [each.after == "pass" for each in mutants]
    assert {*dropped} == {True, False}

    def work() -> int:
        functions = functions_of([file])[file]
        return int([not fits(replacements(file, code, functions)) for _, code in compiled(mutants)] != dropped)

    _, status = os.waitpid(fork(work, math.inf), 0)
    assert os.waitstatus_to_exitcode(status) == 0


def test_a_change_of_a_module_that_no_test_imports_is_untested(tmp_path: Path) -> None:
    """The package is imported already, so that no test of this process does."""
    (tmp_path / "test_rating.py").write_text("def test_nothing():\n    pass\n", encoding="utf-8")
    test = f"{tmp_path}/test_rating.py::test_nothing"
    mutant, tree = next(change for change in mutants_of(ROOT / LAW, ROOT) if change[0].at_import)
    trials = _Trials(
        {test: Trace(0.1, {})},
        Namespace(jobs=1, budget=9.0),
        lambda mutant, code, tests: partial(attempt_at_import, mutant, code, tests),
    )
    trials.start(mutant, compile(tree, str(ROOT / LAW), "exec"), [test])
    trials.finish()
    assert mutant.outcome == "untested"


def test_a_control_raises_in_a_function_that_tests_execute(tmp_path: Path) -> None:
    file = tmp_path / "law.py"
    file.write_text('def idle():\n    pass\ndef law(x):\n    """A law."""\n    return x\n', encoding="utf-8")
    error = control(file, tmp_path, {5})
    assert error is not None
    names: dict[str, object] = {}
    exec(compile(error[1], str(file), "exec"), names)
    with pytest.raises(RuntimeError, match="control"):
        names["law"](1.0)  # type: ignore[operator]
    assert control(file, tmp_path, {4}) is None


def tried(folder: Path, test: str) -> subprocess.CompletedProcess[str]:
    """The tool on a few changes of a file, with a test that is written for it."""
    (folder / "test_rating.py").write_text(test, encoding="utf-8")
    command = [sys.executable, "-m", "tools.mutation", "points/belt_rating.py", "--sample", "6"]
    command += ["--tests", str(folder / "test_rating.py"), "tests/unit/points/test_belt_rating.py"]
    command += ["--out", str(folder / "answers.json")]
    return subprocess.run(command, cwd=ROOT, capture_output=True, encoding="utf-8", check=False)


@pytest.mark.slow
def test_a_test_that_ends_its_process_is_named_and_kills_nothing(tmp_path: Path) -> None:
    result = tried(tmp_path, "import os\n\ndef test_dies():\n    os._exit(3)\n")
    assert result.returncode == 0, result.stderr
    assert "::test_dies ends its process with status 3 while it is traced" in result.stdout
    assert "points/belt_rating.py: " in result.stdout


@pytest.mark.slow
def test_a_control_that_survives_ends_the_run(tmp_path: Path) -> None:
    """Here every call is swallowed: the tests of the file are left out."""
    text = "import pytest\nfrom tests.unit.points import test_belt_rating as tests\n\n"
    text += "def test_nothing():\n    for name, test in vars(tests).items():\n        if name.startswith('test_'):\n"
    text += "            try:\n                test()\n            except BaseException:\n                pass\n"
    (tmp_path / "test_rating.py").write_text(text, encoding="utf-8")
    command = [sys.executable, "-m", "tools.mutation", "points/belt_rating.py", "--sample", "2"]
    command += ["--tests", str(tmp_path / "test_rating.py"), "--out", str(tmp_path / "answers.json")]
    result = subprocess.run(command, cwd=ROOT, capture_output=True, encoding="utf-8", check=False)
    assert result.returncode != 0
    assert "No test notices the control" in result.stdout + result.stderr

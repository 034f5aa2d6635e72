"""What a script needs is there from the start, and found by completion."""

import pkgutil
import re
import subprocess
import sys
from pathlib import Path
from types import ModuleType

import pytest

import beltdyn as bd
import beltdyn.model
import beltdyn.theory


def run(program: str) -> str:
    return subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=True).stdout.strip()


@pytest.mark.parametrize("name", dir(bd))
def test_every_name_is_there(name: str) -> None:
    assert getattr(bd, name) is not None


OF_THE_PACKAGE = {
    "ERROR_LIMITS",
    "Running",
    "describe_time",
    "off_the_stop",
    "unresolved",
    "unstable_balance",
}
"""What models lend to results and solvers, and scripts do not need."""


@pytest.mark.parametrize("package", [beltdyn.model])
def test_the_names_of_models_are_among_them(package: object) -> None:
    assert set(package.__all__) - OF_THE_PACKAGE <= set(dir(bd))  # type: ignore[attr-defined]


def test_modules_are_there_without_anything_else_being_used_before() -> None:
    used = "bd.results.VARIABLES, bd.derived.slips, bd.theory.capstan.capstan_ratio, bd.plot.speeds"
    assert run(f"import beltdyn as bd; print(len([{used}]))") == "4"


def test_every_module_of_theory_is_named() -> None:
    assert sorted(beltdyn.theory.__all__) == [found.name for found in pkgutil.iter_modules(beltdyn.theory.__path__)]


def test_importing_the_package_imports_nothing_heavy() -> None:
    heavy = "{'numpy', 'numba', 'pydantic', 'scipy', 'xarray', 'matplotlib'}"
    assert run(f"import sys, beltdyn; dir(beltdyn); print({heavy} & set(sys.modules))") == "set()"


def test_the_reference_tells_of_every_name() -> None:
    reference = (Path(__file__).parents[2] / "docs" / "reference.md").read_text(encoding="utf-8")
    listed = set(re.findall(r"^    (\w+)$", reference, flags=re.MULTILINE))
    modules = {name for name in dir(bd) if isinstance(getattr(bd, name), ModuleType)}
    assert set(dir(bd)) - modules - {"VARIABLES"} <= listed
    assert set(bd.plot.__all__) - {"FIGURES"} <= listed
    assert set(bd.derived.__all__) <= listed

"""Names of a stub file, imported at their first use."""

import subprocess
import sys
from importlib import import_module
from pathlib import Path

import pytest

import beltdyn as bd
from beltdyn.lazy import LazyNames
from beltdyn.machines import loads
from beltdyn.machines.loads.load import LOADS


@pytest.fixture
def names(tmp_path: Path) -> LazyNames:
    stub = tmp_path / "stub.pyi"
    stub.write_text(
        "from typing import Any\nfrom . import errors\nfrom .machines.loads import *\n"
        "from beltdyn.kinds import register\n",
        encoding="utf-8",
    )
    return LazyNames("beltdyn", stub)


def test_the_names_are_those_of_the_stub_and_of_the_packages_that_it_passes_on(names: LazyNames) -> None:
    kinds = {kind.__name__ for name, kind in LOADS.items() if not LOADS.is_own(name)}
    assert set(names) == {"errors", "register", *kinds}
    assert len(names) == len(kinds) + 2


def test_a_name_is_a_module_or_its_attribute(names: LazyNames) -> None:
    assert names["errors"] is bd.errors
    assert names["Fan"] is loads.Fan
    with pytest.raises(KeyError):
        names["Any"]


@pytest.mark.parametrize("module", ["beltdyn", "beltdyn.extend"])
def test_what_is_not_there_is_no_attribute(module: str) -> None:
    with pytest.raises(AttributeError, match="has no attribute 'nothing'"):
        getattr(import_module(module), "nothing")  # noqa: B009


def test_what_extends_the_package_loads_no_more_than_it_uses() -> None:
    program = "import sys; from beltdyn.extend import register; print('numpy' in sys.modules)"
    done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "False"

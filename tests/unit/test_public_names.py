"""What a script needs is found by completion, and nothing else; the rest is in submodules of one subject."""

import pkgutil
import re
import subprocess
import sys
from pathlib import Path
from types import ModuleType
from typing import Any

import pytest

import beltdyn as bd
import beltdyn.theory
from beltdyn.analyses import ANALYSES
from beltdyn.kinds import Registry
from beltdyn.machines.carrying.support import SUPPORTS
from beltdyn.machines.links.link import LINKS
from beltdyn.machines.loads.load import LOADS
from beltdyn.machines.profiles.profile import PROFILES
from beltdyn.machines.tensioners.tensioner import TENSIONERS


def run(program: str) -> str:
    return subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=True).stdout.strip()


MOST = 60
"""Names that a user looks through."""


def test_completion_shows_what_a_user_needs() -> None:
    assert len(dir(bd)) <= MOST
    assert all(getattr(bd, name) is not None for name in dir(bd))


OF_THE_PACKAGE = {
    "ERROR_LIMITS",
    "Running",
    "describe_time",
    "off_the_stop",
    "unresolved",
    "unstable_balance",
}
"""What models lend to results and solvers, and scripts do not need."""


def test_modules_are_there_without_anything_else_being_used_before() -> None:
    used = (
        "bd.results.VARIABLES, bd.derived.slips, bd.theory.creep.capstan_ratio, bd.plot.speeds, bd.model.Fan, "
        "bd.extend.figure"
    )
    assert run(f"import beltdyn as bd; print(len([{used}]))") == "6"


def test_every_module_of_theory_is_named() -> None:
    assert sorted(beltdyn.theory.__all__) == [found.name for found in pkgutil.iter_modules(beltdyn.theory.__path__)]


def test_importing_the_package_imports_nothing_heavy() -> None:
    heavy = "{'numpy', 'numba', 'pydantic', 'scipy', 'xarray', 'matplotlib'}"
    assert run(f"import sys, beltdyn; dir(beltdyn); print({heavy} & set(sys.modules))") == "set()"


def test_the_reference_tells_of_every_name() -> None:
    reference = (Path(__file__).parents[2] / "docs" / "reference.md").read_text(encoding="utf-8")
    sections = dict(re.findall(r"currentmodule:: (\S+)\n(.*?)```", reference, flags=re.DOTALL))
    listed = set(re.findall(r"^    (\w+)$", reference, flags=re.MULTILINE))
    modules = {name for name in dir(bd) if isinstance(getattr(bd, name), ModuleType)}
    families: list[Registry[Any]] = [LOADS, LINKS, TENSIONERS, PROFILES, SUPPORTS]
    kinds = {kind.__name__ for family in families for kind in family.values()}
    tables = ("load", "hub", "tensioner", "support", "profile", "analysis", "figure")
    assert all(f"<!-- kinds.{table} -->" in reference for table in tables)
    assert set(dir(bd)) - modules - set(ANALYSES) <= listed
    assert kinds <= set(bd.model.__all__)
    assert set(bd.model.__all__) - OF_THE_PACKAGE - kinds <= listed
    assert set(bd.plot.__all__) - set(bd.plot.FIGURES) - {"FIGURES"} <= listed
    assert set(bd.derived.__all__) <= listed
    assert set(bd.extend.__all__) == set(re.findall(r"^    (\w+)$", sections["beltdyn.extend"], flags=re.MULTILINE))


@pytest.mark.parametrize("shown", ["drive", "run", "rest"])
def test_a_repr_says_in_two_lines_what_it_is(shown: str) -> None:
    drive = bd.example("two_pulley")
    drive = drive.replace(simulation=drive.simulation.replace(duration=1e-3))
    run = bd.simulate(drive)
    said = {
        "drive": 'Drive "Belt drive": driver, driven; belt of 1.2727 m',
        "run": 'Run of "Belt drive": 0 to 0.001 s, ',
        "rest": 'StaticResult of "Belt drive": equilibrium, ',
    }
    assert repr({"drive": drive, "run": run, "rest": bd.equilibrium(drive)}[shown]).startswith(said[shown])

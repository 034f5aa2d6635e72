"""Compilation in two processes."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

from beltdyn.observation.compilation import usable_cores

COMPILE = """
from beltdyn.model import prepare
from validation.published import loaded_two_pulley
from beltdyn.observation.compilation import compile_kernels
from beltdyn.solvers.engine import dispatch
from beltdyn.system.build import drive_system
from beltdyn.system.state import laid

drive = loaded_two_pulley()
drive = drive.replace(belt=drive.belt.replace(discretization="{}"))
system = drive_system(prepare(drive))
compile_kernels(system, laid(system, drive.path))
print(sum(dispatch.dispatcher.stats.cache_hits.values()), sum(dispatch.dispatcher.stats.cache_misses.values()))
"""


@pytest.mark.slow
@pytest.mark.skipif(usable_cores() < 2, reason="one core: one process compiles all")
@pytest.mark.parametrize("discretization", ["ancf", "truss"])
def test_a_second_process_compiles_what_this_drive_needs(tmp_path: Path, discretization: str) -> None:
    process = subprocess.run(
        [sys.executable, "-c", COMPILE.format(discretization)],
        env={**os.environ, "BELTDYN_CACHE_DIR": str(tmp_path)},
        check=True,
        capture_output=True,
        text=True,
    )
    assert process.stdout.split() == ["1", "0"]


STEADY = """
from beltdyn.model import example
from beltdyn.state.steady import steady_state
from beltdyn.system.observe import fill_observations

steady_state(example("unequal_radii"))
stats = fill_observations.dispatcher.stats
print(sum(stats.cache_hits.values()), sum(stats.cache_misses.values()))
"""


@pytest.mark.slow
@pytest.mark.skipif(usable_cores() < 2, reason="one core: one process compiles all")
def test_a_second_process_compiles_what_observes_steady_running(tmp_path: Path) -> None:
    process = subprocess.run(
        [sys.executable, "-c", STEADY],
        env={**os.environ, "BELTDYN_CACHE_DIR": str(tmp_path)},
        check=True,
        capture_output=True,
        text=True,
    )
    assert process.stdout.split() == ["1", "0"]

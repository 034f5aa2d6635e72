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


@pytest.mark.slow
def test_two_processes_that_compile_at_once_share_one_sound_cache(tmp_path: Path) -> None:
    """Each kernel is compiled by one of them; a third process compiles none."""
    command = [sys.executable, "-W", "error", "-c", COMPILE.format("truss")]
    surroundings = {**os.environ, "BELTDYN_CACHE_DIR": str(tmp_path)}
    pipes = {"stdout": subprocess.PIPE, "stderr": subprocess.PIPE, "text": True}
    both = [subprocess.Popen(command, env=surroundings, **pipes) for _ in range(2)]  # type: ignore[call-overload]
    for process in both:
        output, errors = process.communicate(timeout=600)
        assert (process.returncode, errors) == (0, "")
        assert sum(int(count) for count in output.split()) == 1
    kernels = {path.name: path.stat().st_mtime_ns for path in tmp_path.rglob("*.kernel")}
    assert kernels
    third = subprocess.run(command, env=surroundings, check=True, capture_output=True, text=True)
    assert third.stdout.split() == ["1", "0"]
    assert {path.name: path.stat().st_mtime_ns for path in tmp_path.rglob("*.kernel")} == kernels

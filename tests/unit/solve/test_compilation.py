"""Compilation in two processes."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

FIRST = "from beltdyn.solve.compilation import compile_solving; compile_solving()"
THEN = """
from beltdyn.published import loaded_two_pulley
from beltdyn.solve.compilation import compile_kernels
from beltdyn.solve.engine import serve
from beltdyn.system.build import drive_system
from beltdyn.system.state import laid

drive = loaded_two_pulley()
compile_kernels(drive_system(drive), laid(drive_system(drive), drive.path))
print(sum(serve.dispatcher.stats.cache_hits.values()), sum(serve.dispatcher.stats.cache_misses.values()))
"""


@pytest.mark.slow
def test_a_second_process_compiles_what_every_drive_needs(tmp_path: Path) -> None:
    environment = {**os.environ, "BELTDYN_CACHE_DIR": str(tmp_path)}
    subprocess.run([sys.executable, "-c", FIRST], env=environment, check=True)
    process = subprocess.run([sys.executable, "-c", THEN], env=environment, check=True, capture_output=True, text=True)
    assert process.stdout.split() == ["1", "0"]

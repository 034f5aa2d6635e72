"""Quick compilation: code from the disk loads without the compiler, and inlined laws are compiled anew."""

import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from beltdyn.kernel import CACHE_VARIABLE, PACKAGE

_CALLER = """
from beltdyn.contact.friction import ForceSlope
from beltdyn.contact.law import ContactLaw, PulleyState
from beltdyn.contact.normal import NoPull
from beltdyn.contact.penetration import Approach
from beltdyn.contact.point_force import point_force
from beltdyn.contact.surface import Round
law = ContactLaw(NoPull(1e7, 0.0), ForceSlope(1e5), follow_zone=True)
here = Approach(**{name: 0.0 for name in Approach._fields} | {"penetration": 1e-3, "lever": 0.08})
print(point_force(here, PulleyState(0.0, 0.0, Round(0.081), 0.0, 1.2), law).normal.force)
"""
_AREAS = """
import time
from typing import NamedTuple
from beltdyn.kernel import by_type, kernel

class Disc(NamedTuple):
    radius: float

@kernel
def disc_area(disc, count):
    return 3.0 * disc.radius**2 * count

area = by_type({Disc: disc_area}, "area")
choose = area.kernel_for

def choose_slowly(*types):
    print("compiled", flush=True)
    time.sleep(1.0)
    return choose(*types)

area.kernel_for = choose_slowly

@kernel
def twice(disc, count):
    return 2.0 * area(disc, count)
"""


@pytest.mark.slow
def test_of_processes_that_need_the_same_one_compiles_and_the_others_load(tmp_path: Path) -> None:
    """None that needs something else is lost, either."""
    (tmp_path / "areas.py").write_text(_AREAS, encoding="utf-8")
    environment = os.environ | {CACHE_VARIABLE: str(tmp_path / "cache")}

    def start(count: str) -> subprocess.Popen[str]:
        command = [sys.executable, "-c", f"import areas; print(areas.twice(areas.Disc(2.0), {count}))"]
        return subprocess.Popen(command, cwd=tmp_path, env=environment, stdout=subprocess.PIPE, text=True)

    outputs = []
    for _ in range(2):
        processes = [start(count) for count in ("1", "1", "1.0", "1.0")]
        outputs.append([process.communicate()[0].split() for process in processes])
    assert [output[-1] for output in outputs[0]] == ["24.0"] * 4
    assert ["compiled" in output for output in outputs[0]].count(True) == 2
    assert outputs[1] == [["24.0"]] * 4


@pytest.mark.slow
def test_kernels_from_the_disk_need_no_tables_of_the_compiler(tmp_path: Path) -> None:
    """Numba fills them, with SciPy's linear algebra, only where something is compiled; later code may need them."""
    environment = os.environ | {CACHE_VARIABLE: str(tmp_path)}
    tables = "import sys; print('numba.np.arraymath' in sys.modules)"
    later = "import numba, numpy; print(numba.njit(lambda a: numpy.dot(a, a))(numpy.ones(3)))"
    command = [sys.executable, "-c", f"{_CALLER}\n{tables}\n{later}"]
    runs = [subprocess.run(command, env=environment, capture_output=True, text=True, check=True) for _ in range(2)]
    assert [run.stdout.split() for run in runs] == [["10000.0", "True", "3.0"], ["10000.0", "False", "3.0"]]


@pytest.mark.slow
def test_kernels_load_wherever_the_package_lies(tmp_path: Path) -> None:
    """As those of a wheel do; a file of kernels names no folder of the machine that compiled them."""
    copy = tmp_path / "beltdyn"
    shutil.copytree(PACKAGE, copy, ignore=shutil.ignore_patterns("__pycache__"))
    environment = os.environ | {CACHE_VARIABLE: str(tmp_path / "cache")}
    command, kept = [sys.executable, "-c", _CALLER], list[dict[Path, int]]()
    for elsewhere in ({}, {"PYTHONPATH": str(tmp_path)}):
        subprocess.run(command, env=environment | elsewhere, capture_output=True, check=True)
        files = (tmp_path / "cache").rglob("*.kernel")
        kept.append({path: path.stat().st_mtime_ns for path in files})
    assert kept[0] == kept[1]
    assert kept[0]
    assert not any(str(PACKAGE).encode() in path.read_bytes() for path in kept[0])


@pytest.mark.slow
def test_an_edited_law_acts_at_once_in_kernels_that_inline_it(tmp_path: Path) -> None:
    """The file of the caller stays as it is, and so does the folder of the cache."""
    copy = tmp_path / "beltdyn"
    shutil.copytree(PACKAGE, copy, ignore=shutil.ignore_patterns("__pycache__"))
    environment = os.environ | {"PYTHONPATH": str(tmp_path), CACHE_VARIABLE: str(tmp_path / "cache")}
    command = [sys.executable, "-c", _CALLER]

    def force() -> float:
        return float(subprocess.run(command, env=environment, capture_output=True, text=True, check=True).stdout)

    assert force() == force() == 1e4
    law = copy / "contact" / "normal" / "penalty.py"
    text = law.read_text(encoding="utf-8")
    law.write_text(text.replace("law.stiffness * penetration", "3.0 * law.stiffness * penetration"), encoding="utf-8")
    assert force() == 3e4
    assert len(list((tmp_path / "cache").iterdir())) == 2

import os
import shutil
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import numba
import pytest

from beltdyn.kernel import CACHE_VARIABLE, PACKAGE, kernel, kernel_cache, source_hash


@pytest.fixture(autouse=True)
def forget_the_folder() -> Iterator[None]:
    kernel_cache.cache_clear()
    yield
    kernel_cache.cache_clear()


@pytest.fixture
def package(tmp_path: Path) -> Path:
    """Two kernels, of which one calls the other, and a module without any."""
    (tmp_path / "law").mkdir()
    (tmp_path / "law" / "friction.py").write_text("from beltdyn.kernel import kernel\n")
    (tmp_path / "force.py").write_text("from beltdyn.kernel import kernel\nimport law.friction\n")
    (tmp_path / "kernel.py").write_text("from beltdyn.kernel import kernel\nimport numba\n")
    (tmp_path / "plot.py").write_text("import matplotlib\n")
    return tmp_path


@pytest.mark.parametrize("edited", ["law/friction.py", "force.py", "kernel.py"])
def test_an_edited_kernel_starts_a_new_cache(package: Path, edited: str) -> None:
    before = source_hash(package)
    with (package / edited).open("a") as source:
        source.write("# edited\n")
    assert source_hash(package) != before


def test_a_moved_kernel_starts_a_new_cache(package: Path) -> None:
    before = source_hash(package)
    (package / "force.py").rename(package / "law" / "force.py")
    assert source_hash(package) != before


def test_other_sources_keep_the_cache(package: Path) -> None:
    before = source_hash(package)
    (package / "plot.py").write_text("import numpy\n")
    assert source_hash(package) == before


def test_the_cache_is_named_by_the_sources(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv(CACHE_VARIABLE, str(tmp_path / "cache"))
    assert kernel_cache() == tmp_path / "cache" / source_hash(PACKAGE)
    assert kernel_cache().is_dir()


def test_an_unwritable_cache_gives_way_to_a_temporary_one(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    in_the_way = tmp_path / "file"
    in_the_way.touch()
    monkeypatch.setenv(CACHE_VARIABLE, str(in_the_way))
    assert in_the_way not in kernel_cache().parents
    assert kernel_cache().is_dir()


def test_a_temporary_cache_is_gone_at_the_end(tmp_path: Path) -> None:
    in_the_way = tmp_path / "file"
    in_the_way.touch()
    words = [sys.executable, "-c", "from beltdyn.kernel import kernel_cache; print(kernel_cache())"]
    environment = os.environ | {CACHE_VARIABLE: str(in_the_way), "TMPDIR": str(tmp_path)}
    folder = subprocess.run(words, env=environment, capture_output=True, text=True, check=True).stdout.strip()
    assert Path(folder).parent == tmp_path
    assert list(tmp_path.iterdir()) == [in_the_way]


def test_machine_code_lands_in_the_cache(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv(CACHE_VARIABLE, str(tmp_path))

    @kernel
    def double(x: float) -> float:
        return 2.0 * x

    assert double(21.0) == 42.0
    assert list((tmp_path / source_hash(PACKAGE)).rglob("*double*.nbi"))


def test_only_kernels_that_python_calls_become_machine_code(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv(CACHE_VARIABLE, str(tmp_path))

    @kernel(inline=True)
    def _half(x: float) -> float:
        return 0.5 * x

    @kernel
    def inner(x: float, power: int) -> float:
        return _half(x) ** power

    @kernel
    def outer(x: float) -> float:
        return inner(x, 1) + inner(x, 2)

    assert outer(6.0) == 12.0
    assert [path.name.split("-")[0].split(".")[-1] for path in tmp_path.rglob("*.nbi")] == ["outer"]
    assert inner(6.0, 2) == 9.0


def test_without_compilation_kernels_run_as_python(monkeypatch: pytest.MonkeyPatch) -> None:
    """With NUMBA_DISABLE_JIT=1: what could never be compiled is done."""
    monkeypatch.setattr(numba.config, "DISABLE_JIT", True)
    seen: list[float] = []

    @kernel
    def note(x: float) -> float:
        seen.append(x)
        return 2.0 * x

    assert note(3.0) == 6.0
    assert seen == [3.0]


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
def test_an_edited_law_acts_at_once_in_kernels_that_inline_it(tmp_path: Path) -> None:
    """The file of the caller stays as it is, and so does the folder of the cache."""
    copy = tmp_path / "beltdyn"
    shutil.copytree(PACKAGE, copy, ignore=shutil.ignore_patterns("__pycache__"))
    environment = os.environ | {"PYTHONPATH": str(tmp_path), CACHE_VARIABLE: str(tmp_path / "cache")}
    command = [sys.executable, "-c", _CALLER]

    def force() -> float:
        return float(subprocess.run(command, env=environment, capture_output=True, text=True, check=True).stdout)

    assert force() == force() == 1e4
    law = copy / "contact" / "normal" / "no_pull.py"
    text = law.read_text(encoding="utf-8")
    law.write_text(text.replace("law.stiffness * penetration", "3.0 * law.stiffness * penetration"), encoding="utf-8")
    assert force() == 3e4
    assert len(list((tmp_path / "cache").iterdir())) == 2

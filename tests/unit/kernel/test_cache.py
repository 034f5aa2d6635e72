"""The folder of compiled kernels is that of the sources, and is never stale."""

import os
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

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

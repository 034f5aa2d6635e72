"""The folder of compiled kernels is that of the sources, and is never stale."""

import os
import re
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest

from beltdyn.kernel import CACHE_VARIABLE, PACKAGE, KernelCacheWarning, holds_kernels, kernel, kernel_cache, source_hash


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
    with pytest.warns(KernelCacheWarning, match=f"{re.escape(str(in_the_way))} is not usable.*cannot be written"):
        folder = kernel_cache()
    assert in_the_way not in folder.parents
    assert folder.is_dir()
    kernel_cache.cache_clear()
    assert kernel_cache() == folder  # as in the processes that this one starts


def test_a_temporary_cache_is_gone_at_the_end(tmp_path: Path) -> None:
    in_the_way = tmp_path / "file"
    in_the_way.touch()
    words = [sys.executable, "-c", "from beltdyn.kernel import kernel_cache; print(kernel_cache())"]
    environment = os.environ | {CACHE_VARIABLE: str(in_the_way), "TMPDIR": str(tmp_path)}
    folder = subprocess.run(words, env=environment, capture_output=True, text=True, check=True).stdout.strip()
    assert Path(folder).parents[1] == tmp_path
    assert list(tmp_path.iterdir()) == [in_the_way]


def test_a_new_cache_begins_with_the_kernels_of_the_package(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    shipped, name = tmp_path / "shipped", source_hash(PACKAGE)
    (shipped / name).mkdir(parents=True)
    (shipped / name / "one.kernel").write_bytes(b"code")
    (shipped / "of other sources").mkdir()
    monkeypatch.setattr("beltdyn.kernel.fingerprint._SHIPPED", shipped)
    monkeypatch.setenv(CACHE_VARIABLE, str(tmp_path / "cache"))
    assert [path.name for path in (tmp_path / "cache").rglob("*")] == []
    assert (kernel_cache() / "one.kernel").read_bytes() == b"code"
    assert [path.name for path in (tmp_path / "cache").iterdir()] == [name]
    (kernel_cache() / "one.kernel").unlink()
    kernel_cache.cache_clear()
    assert not list(kernel_cache().iterdir())


@pytest.mark.skipif(os.name == "nt", reason="rights of files")
@pytest.mark.parametrize("name", [".", source_hash(PACKAGE), f"{source_hash(PACKAGE)}/law_0"])
def test_a_folder_that_others_can_write_to_is_not_used(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, name: str
) -> None:
    """Whoever writes there has code run by this user."""
    monkeypatch.setenv(CACHE_VARIABLE, str(tmp_path))
    folder = tmp_path / name
    folder.mkdir(parents=True, exist_ok=True)
    folder.chmod(0o777)
    with pytest.warns(KernelCacheWarning, match=f"other users can write to {re.escape(str(folder))}"):
        assert tmp_path not in kernel_cache().parents


@pytest.mark.skipif(os.name == "nt", reason="rights of files")
@pytest.mark.parametrize("named", ["open/closed/cache", "link/cache", "loop/cache"])
def test_every_folder_and_link_on_the_way_counts(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, named: str) -> None:
    """Whoever can write to one of them can put another folder in the place of the next."""
    (tmp_path / "open" / "closed").mkdir(parents=True)
    (tmp_path / "open").chmod(0o777)
    (tmp_path / "open" / "lead").symlink_to(tmp_path / "private")
    (tmp_path / "private").mkdir()
    (tmp_path / "link").symlink_to("open/lead")  # a link by way of a link
    (tmp_path / "loop").symlink_to("loop")
    monkeypatch.setenv(CACHE_VARIABLE, str(tmp_path / named))
    fault = "cannot be written" if named.startswith("loop") else f"other users can write to {tmp_path / 'open'}"
    with pytest.warns(KernelCacheWarning, match=re.escape(fault)):
        assert tmp_path not in kernel_cache().parents
    kernel_cache.cache_clear()
    (tmp_path / "open").chmod(0o1777)  # as that of temporary files: others cannot move what lies there
    monkeypatch.setenv(CACHE_VARIABLE, str(tmp_path / named))
    if not named.startswith("loop"):
        assert kernel_cache().parent == tmp_path / named


@pytest.mark.skipif(not hasattr(os, "getuid"), reason="owners of files")
@pytest.mark.parametrize("alone", [True, False])
def test_groups_count_as_others_but_for_that_of_a_single_user(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, alone: bool
) -> None:
    """Many systems let the user's own group write to whatever the user makes."""
    tmp_path.chmod(0o770)
    monkeypatch.setenv(CACHE_VARIABLE, str(tmp_path / "cache"))
    monkeypatch.setattr(
        "beltdyn.kernel.fingerprint._is_of_one", lambda group: alone and group == tmp_path.stat().st_gid
    )
    if alone:
        assert kernel_cache().parent == tmp_path / "cache"
    else:
        with pytest.warns(KernelCacheWarning, match="other users can write to"):
            assert tmp_path not in kernel_cache().parents


@pytest.mark.skipif(not hasattr(os, "getuid"), reason="owners of files")
def test_a_folder_of_another_user_is_not_used(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv(CACHE_VARIABLE, str(tmp_path))
    monkeypatch.setattr(os, "getuid", lambda: tmp_path.stat().st_uid + 1)
    with pytest.warns(KernelCacheWarning, match="belongs to another user"):
        assert tmp_path not in kernel_cache().parents


@pytest.mark.skipif(os.name == "nt", reason="rights of files")
def test_a_new_folder_is_for_this_user_alone_even_among_those_of_others(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    tmp_path.chmod(0o1777)  # as that of temporary files
    monkeypatch.setenv(CACHE_VARIABLE, str(tmp_path))
    before = os.umask(0)
    try:
        assert kernel_cache().parent == tmp_path
    finally:
        os.umask(before)
    assert kernel_cache().stat().st_mode & 0o777 == 0o700


def test_machine_code_lands_in_the_cache(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv(CACHE_VARIABLE, str(tmp_path))

    @kernel
    def double(x: float) -> float:
        return 2.0 * x

    assert double(21.0) == 42.0
    assert list((tmp_path / source_hash(PACKAGE)).rglob("*double*.kernel"))
    assert holds_kernels(tmp_path)

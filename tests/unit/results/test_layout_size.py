"""Sizes of results before a run: how they grow with it, and what is refused."""

import shutil
from collections.abc import Callable
from math import prod
from pathlib import Path
from types import SimpleNamespace

import psutil
import pytest

from beltdyn.errors import ModelError
from beltdyn.model import Drive, prepare
from beltdyn.results.layout import chunk_rows, describe_size, expected_bytes, require_room
from beltdyn.results.schema import RECORDED

Lasting = Callable[..., Drive]


@pytest.fixture
def lasting(drive: Drive) -> Lasting:
    def make(duration: float, interval: float = 1e-3, **settings: float) -> Drive:
        given = {"duration": duration, "output_interval": interval} | settings
        return drive.replace(simulation=drive.simulation.replace(**given))

    return make


@pytest.mark.parametrize("row", [(), (2,), (100, 2), (60, 60, 60)])
@pytest.mark.parametrize(("dtype", "size"), [("float64", 8), ("float32", 4)])
def test_what_a_file_keeps_together_is_about_32_kilobytes(row: tuple[int, ...], dtype: str, size: int) -> None:
    """At least a row, at most 1024 of them."""
    rows, each = chunk_rows(row, dtype), prod(row) * size
    assert 1 <= rows <= 1024
    assert rows == 1 or rows * each <= 32768
    assert rows == 1024 or (rows + 1) * each > 32768


def test_a_run_of_twice_the_time_takes_twice_the_room(lasting: Lasting) -> None:
    """Beside a header, and what whole chunks of up to 32 kB hold more than the outputs."""
    one, two = (expected_bytes(prepare(lasting(duration))) for duration in (50.0, 100.0))
    assert abs(two - 2 * one) < 64_000 + 32_768 * 2 * len(RECORDED)
    assert two > 1.9 * one


def test_seldom_fields_save_most_of_the_room(lasting: Lasting) -> None:
    """Fields take the room of the mesh, all else that of a few numbers."""
    always, seldom = (expected_bytes(prepare(lasting(10.0, field_interval=interval))) for interval in (1e-3, 1e-2))
    assert 0.1 * always < seldom < 0.21 * always


@pytest.mark.parametrize(("duration", "outputs"), [(1.0, 1001), (10.0, 10001)])
def test_in_words(lasting: Lasting, duration: float, outputs: int) -> None:
    said = describe_size(prepare(lasting(duration, field_interval=0.01)))
    assert f"MB: {outputs} outputs every 0.001 s, {1 + 100 * int(duration)} along the belt every 0.01 s" in said


@pytest.mark.parametrize(("free", "fits"), [(1.001, True), (0.999, False)])
def test_a_disk_must_hold_the_results(
    lasting: Lasting, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, free: float, fits: bool
) -> None:
    drive = lasting(1.0)
    room = int(free * expected_bytes(prepare(drive)))
    monkeypatch.setattr(shutil, "disk_usage", lambda _: SimpleNamespace(free=room))
    if fits:
        require_room(prepare(drive), tmp_path / "run.nc")
    else:
        with pytest.raises(ModelError, match=r"of the disk of .* Write them to another disk, increase simulation"):
            require_room(prepare(drive), tmp_path / "run.nc")


@pytest.mark.parametrize(("free", "fits"), [(2.001, True), (1.999, False)])
def test_memory_must_hold_them_twice(
    lasting: Lasting, monkeypatch: pytest.MonkeyPatch, free: float, fits: bool
) -> None:
    """While they are put together."""
    drive = lasting(1.0)
    room = free * expected_bytes(prepare(drive))
    monkeypatch.setattr(psutil, "virtual_memory", lambda: SimpleNamespace(available=room))
    if fits:
        require_room(prepare(drive), None)
    else:
        with pytest.raises(ModelError, match=r"of memory, .* Write them to a file \(output=...\), increase"):
            require_room(prepare(drive), None)


def test_a_folder_that_is_missing_is_told_of_by_who_writes(
    drive: Drive, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(shutil, "disk_usage", lambda _: SimpleNamespace(free=0))
    require_room(prepare(drive), tmp_path / "nowhere" / "run.nc")

"""Damaged result files: cut short or with changed bytes, they are read, or refused with one message."""

import math
import time
from pathlib import Path
from random import Random
from typing import Any

import matplotlib.pyplot as plt
import numpy as np
import pytest

from beltdyn import plot
from beltdyn.errors import ModelError
from beltdyn.results import FileRecorder, open_run, summarize

OUTPUTS = 5
LONGEST = 10.0
"""Processor time that a file may take where time is looked at, s."""

LONGEST_MESSAGE = 1000


@pytest.fixture
def intact(layout: Any, attributes: Any, statistics: Any, make_chunk: Any, tmp_path: Path) -> bytes:
    """Bytes of a small result file."""
    recorder = FileRecorder(tmp_path / "intact.nc", layout, attributes)
    recorder.append(make_chunk(np.linspace(0.0, 1.0, OUTPUTS)))
    recorder.close("completed", statistics)
    return recorder.path.read_bytes()


def use(path: Path) -> None:
    """Do what is done with a result file."""
    run = open_run(path)
    try:
        assert len(summarize(run).pulleys) == 2
        assert isinstance(run.warnings, list)
        for figure in (plot.span_tensions, plot.configuration):
            figure(run)
    finally:
        run.dataset.close()
        plt.close("all")


def damaged(data: bytes, seed: int) -> bytes:
    """Cut a file, or change some of its bytes."""
    random = Random(seed)
    if seed % 2:
        return data[: random.randrange(len(data))]
    changed = bytearray(data)
    for _ in range(random.choice((1, 8, 64))):
        changed[random.randrange(len(data))] = random.randrange(256)
    return bytes(changed)


@pytest.mark.filterwarnings("ignore")
@pytest.mark.parametrize(
    ("seeds", "longest"),
    [(range(12), math.inf), pytest.param(range(12, 400), LONGEST, marks=pytest.mark.slow)],
    ids=["a dozen", "many"],
)
def test_damaged_files_are_read_or_refused(intact: bytes, tmp_path: Path, seeds: range, longest: float) -> None:
    path, refused = tmp_path / "result.nc", 0
    for seed in seeds:
        path.write_bytes(damaged(intact, seed))
        begun = time.process_time()
        try:
            use(path)
        except ModelError as error:
            refused += 1
            assert 0 < len(str(error)) < LONGEST_MESSAGE, seed  # noqa: PT017
        assert time.process_time() - begun < longest, seed
    assert refused > len(seeds) / 3


@pytest.mark.filterwarnings("ignore")
def test_the_undamaged_file_is_read(intact: bytes, tmp_path: Path) -> None:
    assert len(intact) > 100_000
    use(tmp_path / "intact.nc")

import random
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest
import xarray as xr

from beltdyn.results.dataset import open_dataset

WRITER = Path(__file__).with_name("writer_process.py")
PERIOD = 100


@pytest.mark.slow
def test_killed_writer_leaves_complete_outputs(tmp_path: Path) -> None:
    _write_kill_and_read(tmp_path / "result.nc", outputs=7)


@pytest.mark.slow
@pytest.mark.parametrize("trial", range(20))
def test_killed_writer_leaves_complete_outputs_again_and_again(tmp_path: Path, trial: int) -> None:
    _write_kill_and_read(tmp_path / "result.nc", outputs=(1, 7, 50)[trial % 3])


def _write_kill_and_read(path: Path, outputs: int) -> None:
    command = [sys.executable, str(WRITER), str(path), str(outputs)]
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as process:
        assert process.stdout is not None
        assert process.stdout.readline() == "ready\n"
        time.sleep(random.uniform(0.02, 0.3))
        process.kill()
    with open_dataset(path) as dataset:
        numbers = np.arange(dataset.sizes["time"]) % PERIOD
        assert len(numbers) % outputs == 0
        assert len(dataset.data_vars) > 20
        for name in dataset.data_vars:
            values = dataset[name].values
            rows = values.reshape(len(numbers), int(np.prod(values.shape[1:])))
            np.testing.assert_array_equal(rows, np.broadcast_to(numbers[:, None], rows.shape))
    with xr.open_dataset(path) as plain:
        plain.load()

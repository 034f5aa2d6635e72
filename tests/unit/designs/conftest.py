"""A drive at points of different widths, analyzed by what takes no time."""

from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from beltdyn.analyses import Analysis
from beltdyn.designs.point_work import PointWork
from beltdyn.model import Drive


@pytest.fixture
def tiny_work(drive: Drive, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Callable[..., PointWork]:
    """Makes the work of `tiny_analysis`, which processes find on their path, with its options."""
    monkeypatch.syspath_prepend(str(Path(__file__).parent))
    analysis = Analysis("tiny_analysis:tiny", "Give the width.")

    def make(**options: Any) -> PointWork:
        return PointWork(drive, analysis, {"folder": str(tmp_path)} | options, ("width",), None)

    return make

"""An analysis that takes next to no time, or kills its process, for the tests of those who compute points."""

import os
import signal
import time
from pathlib import Path

from beltdyn.model import Drive
from beltdyn.results import Result, Variable, build_result


def tiny(drive: Drive, *, seconds: float = 0.0, folder: str = "", kills: int = 0) -> Result:
    """Give the width of the belt; where it is 13 mm, kill this process as often as is asked for."""
    if abs(drive.belt.width - 0.013) < 1e-9 and len(list(Path(folder).glob("killed*"))) < kills:
        (Path(folder) / f"killed-{os.getpid()}").touch()
        os.kill(os.getpid(), signal.SIGKILL)
    if folder:
        with (Path(folder) / "computed").open("a", encoding="utf-8") as file:
            file.write(f"{drive.belt.width:.6f} {os.getpid()}\n")
    end = time.process_time() + seconds
    while time.process_time() < end:
        pass
    return build_result("tiny", drive, {"width": (Variable((), "m", "Width"), drive.belt.width)}, {})

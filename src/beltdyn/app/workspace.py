"""Data shared by all tabs: folder, first drive file, and examples."""

from pathlib import Path
from tempfile import TemporaryDirectory
from typing import NamedTuple

from beltdyn.app.calculator import Calculator
from beltdyn.app.folder import Folder
from beltdyn.app.jobs import Job
from beltdyn.model.examples import example_texts

EMPTY = """\
# A belt drive for beltdyn. Numbers are in SI units (m, kg, s, N, rad); "25 mm" or "720 rpm" work too.
# Speeds, torques and angles are positive counter-clockwise.

[belt]
profile = "PK"               # beltdyn catalogue lists the profiles
ribs = 6
installed_tension = "300 N"  # at rest; the length follows

[simulation]
duration = 0.5
output_interval = "1 ms"
"""
"""The empty drive file: a belt without pulleys."""
_USUAL = "alternator_drive"


class Example(NamedTuple):
    """A drive of the gallery."""

    name: str
    about: str
    text: str


class Workspace:
    """Data shared by all tabs.

    Parameters
    ----------
    folder : Folder
        Where drive files are.
    first : str, optional
        Name of the file that a new tab opens.
    calculator : Calculator, optional
        What computes numbers that follow each change; without one there are estimates at rest.
    """

    def __init__(self, folder: Folder, first: str | None = None, calculator: Calculator | None = None) -> None:
        self.folder = folder
        self.first = first
        self.calculator = calculator
        self.jobs: set[Job] = set()
        self._results: TemporaryDirectory[str] | None = None

    @property
    def results(self) -> Path:
        """A folder for results, removed with the server."""
        if self._results is None:
            self._results = TemporaryDirectory(prefix="beltdyn-app-", ignore_cleanup_errors=True)
        return Path(self._results.name)

    @property
    def usual_drive(self) -> str:
        """The drive file of a new tab, or else an example: most drives need its kernels."""
        if self.first is not None:
            return self.folder.read(self.first)
        return next(one.text for one in examples() if one.name == _USUAL)

    def close(self) -> None:
        """End the processes of the tabs."""
        for job in self.jobs:
            job.close()
        if self.calculator is not None:
            self.calculator.close()
        if self._results is not None:
            self._results.cleanup()


def examples() -> list[Example]:
    """The drives of the gallery, described by the first lines of their files."""
    found = []
    for name, text in example_texts().items():
        about = " ".join(line.lstrip("# ") for line in text.partition("\n\n")[0].splitlines() if line[:1] == "#")
        found.append(Example(name, about.partition(" # ")[0], text))
    return found

"""Data shared by all tabs: folder, first drive file, and examples."""

import os
from functools import cache
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import NamedTuple

from beltdyn.app.computing import Calculator
from beltdyn.app.jobs import Job
from beltdyn.errors import ModelError
from beltdyn.model import loads
from beltdyn.model.toml import example_texts
from beltdyn.parts.messages import reason
from beltdyn.parts.text_file import LONGEST_TOML, read_text, shorten
from beltdyn.results.atomic import atomic_path
from beltdyn.show.notebook import picture

# The only folder that the page reads and writes

_SUFFIX = ".toml"
_MAX_DEPTH = 3
"""Depth to which subfolders are searched: a deep tree must not delay the page."""
_MAX_FILES = 200
"""Number of files in a list at most: the search ends there, so that the page need not wait for it."""
_MAX_FOLDERS = 500
"""Number of folders after which no subfolders are searched: a large folder must not delay the page."""


class Folder:
    """Drive files below a folder."""

    def __init__(self, root: Path) -> None:
        self.root = root.resolve()

    def files(self, *suffixes: str) -> list[str]:
        """Names of files with one of these suffixes, by default of drive files, the nearest first.

        Hidden ones, and links to elsewhere, are left out.
        """
        suffixes = suffixes or (_SUFFIX,)
        found = list[str]()
        for looked, (place, folders, names) in enumerate(os.walk(self.root)):
            here = Path(place).relative_to(self.root)
            folders[:] = sorted(one for one in folders if not one.startswith((".", "_")))
            if len(here.parts) >= _MAX_DEPTH or looked > _MAX_FOLDERS:
                folders.clear()
            found += [
                (here / name).as_posix()
                for name in sorted(names)
                if name.endswith(suffixes) and not name.startswith(".") and self._holds(here / name)
            ]
            if len(found) >= _MAX_FILES:
                break
        return sorted(found[:_MAX_FILES], key=lambda name: (name.count("/"), name))

    def path(self, name: str) -> Path:
        """The path of a file by its name."""
        name = name.strip()
        named = name if name.endswith(_SUFFIX) else f"{name}{_SUFFIX}"
        hidden = any(part.startswith(".") for part in Path(named).parts)
        if not name or len(name) > 200 or "\0" in name or hidden or not self._holds(Path(named)):
            raise ModelError(f'"{shorten(name)}" is not a file name in {self.root}. Give a name such as "drive.toml".')
        return (self.root / named).resolve()

    def read(self, name: str) -> str:
        """Read a drive file."""
        path = self.path(name)
        try:
            return read_text(path, LONGEST_TOML)
        except UnicodeDecodeError as error:
            raise ModelError(f"{path} is not UTF-8 text. A drive file is TOML.") from error
        except (OSError, ValueError) as error:
            raise ModelError(f"{path} cannot be read: {reason(error)}. Check the path.") from error

    def write(self, name: str, text: str, known: str | None = None) -> Path:
        """Write a drive file."""
        path = self.path(name)
        if path.exists() and (known is None or self.read(name) != known):
            changed = "already exists" if known is None else "was changed by another program"
            raise ModelError(f"{path} {changed} and would be overwritten. Save under another name.")
        if not path.parent.is_dir():
            raise ModelError(f"{path.parent} is not a folder. Create it, or save elsewhere.")
        with atomic_path(path, lambda _: True) as temporary:
            temporary.write_text(text, encoding="utf-8")
        return path

    def _holds(self, name: Path) -> bool:
        try:
            return (self.root / name).resolve().is_relative_to(self.root)
        except (OSError, ValueError, RuntimeError):
            return False


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
STARTS = {
    "unequal_radii": "Two pulleys",
    "alternator_drive": "Alternator with a tensioner",
    "accessory_drive": "Accessory drive",
    "fan_direct_start": "Fan with V-belts",
    "conveyor": "Conveyor",
    "washing_machine": "Washing machine",
    "servo_axis": "Servo axis with a toothed belt",
}
"""Examples that the empty canvas offers, by what users call them."""


class Example(NamedTuple):
    """A drive of the gallery."""

    name: str
    about: str
    text: str


class Workspace:
    """Data shared by all tabs; without a calculator, numbers that follow a change are estimates at rest."""

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


@cache
def thumbnail(text: str) -> str:
    """A small picture of a drive file of the gallery, as SVG."""
    shown = picture(loads(text))
    circles = "".join(f'<circle cx="{one.x:.1f}" cy="{one.y:.1f}" r="{one.radius:.1f}"/>' for one in shown.circles)
    box = f"0 0 {shown.width:.0f} {shown.height:.0f}"
    return f'<svg viewBox="{box}" aria-hidden="true">{circles}<path d="{shown.belt}"/></svg>'


def examples() -> list[Example]:
    """The drives of the gallery, described by the first lines of their files."""
    found = []
    for name, text in example_texts().items():
        about = " ".join(line.lstrip("# ") for line in text.partition("\n\n")[0].splitlines() if line[:1] == "#")
        found.append(Example(name, about.partition(" # ")[0], text))
    return found

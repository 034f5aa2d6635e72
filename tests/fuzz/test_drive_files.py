"""Thousands of wrong drive files: each is taken, or refused with a message; none ends in a traceback or takes long.

BELTDYN_MUTATIONS says how many are checked (a fifth of them is brought to rest, too),
and BELTDYN_FIRST_MUTATION the first seed.
"""

import contextlib
import os
import signal
import sys
import time
import traceback
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest
from drive_mutations import bases, mutated

from beltdyn.errors import BeltdynError
from beltdyn.model import Drive, advise, install, load, loads
from beltdyn.solve import equilibrium

FIRST = int(os.environ.get("BELTDYN_FIRST_MUTATION", "0"))
COUNT = int(os.environ.get("BELTDYN_MUTATIONS", "1000"))
LONGEST = 10.0
"""CPU time that a file may take, s."""

LARGEST = 1_000_000
"""Growth of the memory of the process over all files, kB."""

LONGEST_MESSAGE = 30_000
COARSE = 40
"""Elements at most where equilibria are found."""


class TooLongError(Exception):
    """A file took too long."""


@contextlib.contextmanager
def limited(seconds: float) -> Iterator[None]:
    """End what takes longer, where the system can tell."""
    if not hasattr(signal, "setitimer"):
        yield
        return

    def stop(*_: object) -> None:
        raise TooLongError

    before = signal.signal(signal.SIGVTALRM, stop)
    signal.setitimer(signal.ITIMER_VIRTUAL, seconds)
    try:
        yield
    finally:
        signal.setitimer(signal.ITIMER_VIRTUAL, 0)
        signal.signal(signal.SIGVTALRM, before)


def look(drive: Drive) -> None:
    """Look at a drive at rest by closed forms, as `beltdyn check` does."""
    advise(drive, install(drive))


def balance(drive: Drive) -> None:
    """Find the equilibrium of a drive, as `beltdyn static` does, on a coarse mesh."""
    coarse = drive.replace(belt=drive.belt.replace(elements=min(drive.elements, COARSE)))
    assert isinstance(equilibrium(coarse).warnings, list)


def outcome(path: Path, use: Callable[[Drive], None]) -> str:
    """Read a file and use the drive: what went wrong beside a refusal in words; empty if nothing did."""
    try:
        with limited(LONGEST):
            use(load(path))
    except BeltdynError as error:
        return "" if 0 < len(str(error)) < LONGEST_MESSAGE else f"a message of {len(str(error))} characters"
    except TooLongError:
        return "took too long"
    except BaseException as error:
        place = traceback.extract_tb(error.__traceback__)[-1]
        return f"{type(error).__name__}: {str(error)[:100]} ({Path(place.filename).name}:{place.lineno})"
    return ""


def peak_memory() -> int:
    """Largest memory of this process so far, kB; 0 where that is not known."""
    if sys.platform != "linux":
        return 0
    import resource

    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss


@pytest.mark.slow
@pytest.mark.filterwarnings("default")
@pytest.mark.parametrize(("use", "count"), [(look, COUNT), (balance, COUNT // 5)], ids=["check", "static"])
def test_wrong_drive_files_are_refused_in_words(tmp_path: Path, use: Callable[[Drive], None], count: int) -> None:
    originals, wrong, slowest = bases(), dict[int, str](), (0.0, -1)
    for original in originals:  # kernels are compiled before the clock of a file starts
        with contextlib.suppress(BeltdynError):  # the coarse mesh is too coarse for some
            balance(loads(original))
    memory = peak_memory()
    for seed in range(FIRST, FIRST + count):
        drive, table = mutated(seed, originals)
        (tmp_path / "drive.toml").write_bytes(drive)
        (tmp_path / "table.csv").write_bytes(table)
        (tmp_path / "wrong.csv").write_bytes(b"user:x:0:0\nroot:y:1:1\n")
        begun = time.process_time()
        result = outcome(tmp_path / "drive.toml", use)
        slowest = max(slowest, (time.process_time() - begun, seed))
        if result:
            wrong[seed] = result
    sys.stdout.write(f"{count} files, slowest {slowest[0]:.2f} s (seed {slowest[1]}), {len(wrong)} wrong\n")
    assert wrong == {}
    assert peak_memory() - memory < LARGEST

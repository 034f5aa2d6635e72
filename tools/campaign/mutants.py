"""Wrong drive files: each is taken, or refused with a message."""

import contextlib
import signal
import time
from collections.abc import Callable, Iterator
from pathlib import Path

from beltdyn.model import Drive, load
from beltdyn.show.rest_sheet import check
from beltdyn.state.equilibrium import equilibrium
from tools.campaign.drive_mutations import mutated
from tools.campaign.trial import Outcome, outcome

LONGEST = 10.0
"""Processor time that a file may take, s."""
COARSE = 40
"""Elements at most where equilibria are found."""


class TooLongError(BaseException):
    """A file took too long."""


def look(drive: Drive) -> None:
    """Look at a drive at rest by closed forms, as `beltdyn check` does before kernels are compiled."""
    assert str(check(drive, equilibrium=False))


def balance(drive: Drive) -> None:
    """Find the equilibrium of a drive, as `beltdyn static` does, on a coarse mesh of equal elements."""
    coarse = drive.replace(belt=drive.belt.replace(elements=min(drive.belt.elements or COARSE, COARSE)))
    assert isinstance(equilibrium(coarse).warnings, list)


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


def try_mutant(seed: int, originals: list[str], folder: Path, use: Callable[[Drive], None] = look) -> Outcome:
    """Read a wrong drive file and use the drive.

    Parameters
    ----------
    seed
        The same file for the same number.
    originals
        What is changed, from `drive_mutations.bases`.
    folder
        Where files are written.
    use
        What is done with a drive that is taken.
    """
    drive, table = mutated(seed, originals)
    (folder / "drive.toml").write_bytes(drive)
    (folder / "table.csv").write_bytes(table)
    (folder / "wrong.csv").write_bytes(b"user:x:0:0\nroot:y:1:1\n")

    def work() -> str:
        with limited(LONGEST):
            use(load(folder / "drive.toml"))
        return ""

    begun = time.process_time()
    kind, text = outcome(work)
    return Outcome("too long" if text.startswith("TooLongError") else kind, text, time.process_time() - begun)

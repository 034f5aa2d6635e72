"""Hostile files, and small ones that ask for endless work: refused at once, and nothing of them is run."""

import os
import pickle
import time
from collections.abc import Callable, Iterator
from importlib.resources import files
from pathlib import Path

from beltdyn.cli import main
from beltdyn.model import dumps
from beltdyn.transient.checkpoint import checkpoint_file
from tools.campaign.damage import two_pulley

MARKER = "executed"
"""Name of the file that code would make if it were run."""

_STARTING = 0.5
"""Time after which a command that was started has made it, s."""

Case = tuple[str, Callable[[Path], list[str]]]
"""Name, and what makes the files in a folder and gives the words after `beltdyn`."""


class _Runs:
    """What runs a command when it is unpickled."""

    def __init__(self, marker: Path) -> None:
        self.command = f"__import__('pathlib').Path({str(marker)!r}).touch()"

    def __reduce__(self) -> tuple[Callable[[str], object], tuple[str]]:
        return exec, (self.command,)


def payload(marker: Path) -> bytes:
    """A pickle that makes a file when it is loaded."""
    return pickle.dumps(_Runs(marker))


def dotted_payload(marker: Path) -> bytes:
    """A pickle that reaches a class through a module of beltdyn that imports its module."""
    name = _text("beltdyn.observation.compilation") + _text("subprocess.Popen") + b"\x93"
    return b"\x80\x04" + name + b"](" + _text("touch") + _text(str(marker)) + b"e\x85R."


def _text(text: str) -> bytes:
    return b"\x8c" + bytes([len(text)]) + text.encode()


def _drive(folder: Path, old: str = "", new: str = "", before: str = "") -> str:
    text = files("beltdyn").joinpath("examples", "two_pulley.toml").read_text(encoding="utf-8")
    assert old in text
    file = folder / "drive.toml"
    file.write_text(before + text.replace(old, new, 1), encoding="utf-8")
    return str(file)


def _checkpoint(folder: Path, content: bytes, head: bytes) -> list[str]:
    drive = _drive(folder)
    checkpoint_file(folder / "drive.nc").write_bytes(head + content)
    return ["simulate", drive, "--resume"]


def _pipe(folder: Path, name: str) -> str:
    os.mkfifo(folder / name)
    return str(folder / name)


def _pulleys(folder: Path, count: int) -> list[str]:
    head = dumps(two_pulley()).partition("[[pulley]]")[0]
    one = '[[pulley]]\nname = "p{0}"\ncenter = [{0}, 0]\nradius = 0.1\ninertia = 1\n'
    (folder / "drive.toml").write_text(head + "".join(one.format(number) for number in range(count)), encoding="utf-8")
    return ["check", str(folder / "drive.toml")]


def _table(folder: Path, rows: int) -> list[str]:
    (folder / "table.csv").write_text("".join(f"{row},{row % 7}\n" for row in range(rows)), encoding="utf-8")
    drive = two_pulley()
    text = dumps(drive).replace('kind = "cosine_ramp", start = 0.05, end = 0.6, value = 0.0', "", 1)
    (folder / "drive.toml").write_text(text, encoding="utf-8")
    one, other = drive.pulleys
    given = other.model_copy(update={"torque": None})
    table = '\n[[pulley.load]]\nkind = "table"\nfile = "table.csv"\n'
    text = dumps(drive.replace(pulley=[one, given])).replace("[contact]", f"{table}\n[contact]", 1)
    (folder / "drive.toml").write_text(text, encoding="utf-8")
    return ["check", str(folder / "drive.toml")]


def cases(head: bytes) -> Iterator[Case]:
    """All cases.

    Parameters
    ----------
    head
        First bytes of a checkpoint of this version.
    """
    yield "pickle in a checkpoint", lambda at: _checkpoint(at, payload(at / MARKER), head)
    yield "dotted name in a checkpoint", lambda at: _checkpoint(at, dotted_payload(at / MARKER), head)
    yield "bare pickle as a checkpoint", lambda at: _checkpoint(at, payload(at / MARKER), b"")
    for command in ("check", "simulate", "plot", "export", "study", "report"):
        yield f"pipe as the file of {command}", lambda at, word=command: [word, _pipe(at, "pipe.toml")]  # type: ignore[misc]
        yield f"/dev/zero as the file of {command}", lambda at, word=command: [word, "/dev/zero"]  # type: ignore[misc]
        yield f"folder as the file of {command}", lambda at, word=command: [word, str(at)]  # type: ignore[misc]
    yield "pipe as the run to start from", _start_from_a_pipe
    yield "pipe as a checkpoint", lambda at: _with_pipe(at, checkpoint_file(at / "drive.nc").name)
    yield "center at 8e12 m", lambda at: ["check", _drive(at, "center = [0.191441, 0.0]", "center = [8e12, 0.0]")]
    yield "100,000 elements", lambda at: ["check", _drive(at, "elements = 20", "elements = 100000")]
    yield "20,000 pulleys", lambda at: _pulleys(at, 20_000)
    yield "a table of a million rows", lambda at: _table(at, 1_000_000)
    yield "loop of links as output", _onto_a_loop
    yield "names that are markup", lambda at: ["check", _drive(at, '"driver"', '"$$</script><script>1"')]
    yield "a name that no terminal shows", lambda at: ["check", _drive(at, '"driver"', '"\\u202e\\u0007\\u001b[2J"')]
    yield "a number of 100,000 digits", lambda at: ["check", _drive(at, "elements = 20", "elements = " + "9" * 100_000)]
    yield "5,000 brackets", lambda at: ["check", _drive(at, before="a = " + "[" * 5000 + "]" * 5000 + "\n")]
    yield "a file name that is no UTF-8", _no_utf8


def _start_from_a_pipe(folder: Path) -> list[str]:
    start = f'[simulation]\nstart = {{ file = "{_pipe(folder, "start.nc")}" }}'
    text = Path(_drive(folder, "[simulation]", start)).read_text(encoding="utf-8")
    (folder / "drive.toml").write_text(text.replace('start = "laid"', ""), encoding="utf-8")
    return ["check", str(folder / "drive.toml")]


def _with_pipe(folder: Path, name: str) -> list[str]:
    _pipe(folder, name)
    return ["simulate", _drive(folder), "--resume"]


def _onto_a_loop(folder: Path) -> list[str]:
    (folder / "one.nc").symlink_to(folder / "other.nc")
    (folder / "other.nc").symlink_to(folder / "one.nc")
    return ["equilibrium", _drive(folder), "-o", str(folder / "one.nc")]


def _no_utf8(folder: Path) -> list[str]:
    name = os.fsdecode(os.fsencode(folder) + b"/dr\xffive.toml")
    Path(name).write_text(dumps(two_pulley()), encoding="utf-8")
    return ["equilibrium", name, "--report"]


def give(case: Case, folder: Path) -> str:
    """Give hostile files to the command line: the fault, if code of them was run.

    Parameters
    ----------
    case
        One of `cases`.
    folder
        Empty.
    """
    words = case[1](folder)
    try:
        main(words)
    finally:
        time.sleep(_STARTING if "dotted" in case[0] else 0.0)
        if (folder / MARKER).exists():
            raise AssertionError("code of the file was run")
    return ""

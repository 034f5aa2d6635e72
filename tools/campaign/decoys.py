"""Folders that hold modules with the names of others: nothing of them is run, whichever processes a command starts."""

import os
import subprocess
import sys
from collections.abc import Callable
from importlib.metadata import packages_distributions
from pathlib import Path

from beltdyn.kernel import CACHE_VARIABLE
from tools.campaign.stops import prepare

_PROGRAM = "import sys; from beltdyn.cli import main; sys.exit(main())"
"""The command, whose script lies in a folder of its own, which Python puts first on the path."""
_PAGE = """
import http.client, re, subprocess, sys, time
words = [sys.executable, sys.argv[1], "app", "drive.toml", "--no-show"]
page = subprocess.Popen(words, stdout=subprocess.PIPE, text=True)
address = re.search(r"http://([^/]+)(/.*)", page.stdout.readline())
connection = http.client.HTTPConnection(address[1])
connection.request("GET", address[2])
answered = connection.getresponse().status == 200
time.sleep({seconds})
page.terminate()
sys.exit(0 if page.wait() == 143 and answered else 1)
"""
"""The page is opened, and its processes have time to start."""
_BESIDE = "from beltdyn.observation.compilation import beside\nwith beside(len, ()): pass"
"""What has another process compile: here it does nothing."""
_HOST = "import fmpy, sys; fmpy.simulate_fmu('drive.fmu', stop_time=0.002)"
"""A program that runs a unit."""

_LONGEST = 900.0
"""Time on the clock of a route that compiles all its kernels beside other work, s."""

ROUTES = ("beside", "compilation", "processes", "study", "page", "unit", "module")
"""Ways in which processes of Python start; "unsafe", which is none of them, has Python import what lies there."""


def lay(folder: Path, marker: Path) -> int:
    """Write modules with the names of all that can be imported, each of which notes its name in a file: how many."""
    names = {*sys.stdlib_module_names, *packages_distributions(), "beltdyn", "sitecustomize", "usercustomize"}
    for name in sorted(name for name in names if name.isidentifier() and name != "__main__"):
        (folder / f"{name}.py").write_text(f"open({str(marker)!r}, 'a').write('{name} ')\n", encoding="utf-8")
    return len(names)


def words_of(route: str, script: Path, seconds: float) -> list[list[str]]:
    """Words after the interpreter of the commands of a route; a page stays open for a time (s)."""
    page, host, beside = (script.with_name(f"run_{name}.py") for name in ("page", "host", "beside"))
    page.write_text(_PAGE.format(seconds=seconds), encoding="utf-8")
    host.write_text(_HOST, encoding="utf-8")
    beside.write_text(_BESIDE, encoding="utf-8")
    command = str(script)
    return {
        "beside": [[str(beside)]],
        "compilation": [[command, "simulate", "drive.toml"]],
        "processes": [[command, "equilibrium", "drive.toml", "other.toml", "-j", "2"]],
        "study": [[command, "study", "study.toml", "-j", "2"]],
        "page": [[str(page), command]],
        "unit": [[command, "fmu", "drive.toml", "--force"], [str(host)]],
        "module": [["-P", "-m", "beltdyn", "equilibrium", "drive.toml"]],
        "unsafe": [["-m", "beltdyn", "--version"]],
    }[route]


def foreign(route: str, folder: Path, cache: Path | None, *, interpreter: str = sys.executable, open_for: float) -> str:
    """Run a route in a folder of decoys: the fault, if it fails or if one of them is run.

    Parameters
    ----------
    route
        One of `ROUTES`.
    folder
        Where files are written, empty.
    cache
        Where kernels are kept; None for those of the user.
    interpreter
        What starts the commands.
    open_for
        Time for which the page stays open, s.
    """
    work, marker, script = folder / "work", folder / "imported", folder / "bin" / "command.py"
    work.mkdir()
    script.parent.mkdir()
    script.write_text(_PROGRAM, encoding="utf-8")
    prepare(work)
    lay(work, marker)
    environment = {name: value for name, value in os.environ.items() if name != "PYTHONSAFEPATH"}
    if cache is not None:
        environment[CACHE_VARIABLE] = str(cache)
    for words in words_of(route, script, open_for):
        found = subprocess.run(
            [interpreter, *words],
            cwd=work,
            env=environment,
            capture_output=True,
            text=True,
            timeout=_LONGEST,
            check=False,
        )
        if marker.exists():
            return f"imported from the working folder: {marker.read_text(encoding='utf-8')}"
        if found.returncode:
            return f"exit code {found.returncode}: {found.stderr[-600:]}"
    return ""


def trial(route: str, emptied: Callable[[Path], Path], folder: Path) -> str:
    """A route with an empty cache of kernels."""
    return foreign(route, emptied(folder), folder / "kernels", open_for=20.0)

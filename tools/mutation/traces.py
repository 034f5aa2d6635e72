"""What each test executes, and how long it takes."""

import hashlib
import json
import math
import os
import resource
import signal
import tempfile
import time
import warnings
from collections import defaultdict
from dataclasses import dataclass
from itertools import groupby
from pathlib import Path
from typing import Any

import coverage
import pytest

from tools.mutation.trial import ROOT, SETUP, SOURCE, fork, reason_of_failure, silence


@dataclass
class Trace:
    """What a test does.

    Attributes
    ----------
    duration : float
        Processor time, s.
    lines : dict[str, list[int]]
        Lines that it executes, by file.
    """

    duration: float
    lines: dict[str, list[int]]


def traces(items: list[pytest.Item], folders: list[str], seconds: float, kept: Path) -> dict[str, Trace]:
    """Find out what each test executes, unless it is known.

    Parameters
    ----------
    items : list[pytest.Item]
        The tests.
    folders : list[str]
        Folders below the package whose lines are wanted.
    seconds : float
        Processor time after which a test is given up.
    kept : Path
        File with what is known, which is brought up to date.

    Returns
    -------
    dict[str, Trace]
        By the id of a test; without those that fail or take too long.
    """
    common = _digest(*sorted(SOURCE.rglob("*.py")), *sorted((ROOT / "tests").rglob("conftest.py"))) + str(folders)
    known = json.loads(kept.read_text(encoding="utf-8")) if kept.exists() else {}
    found: dict[str, Any] = {}
    for path, group in groupby(items, lambda item: item.path):
        tests, digest = list(group), common + _digest(path)
        same = {item.nodeid: known[item.nodeid] for item in tests if item.nodeid in known}
        if len(same) < len(tests) or any(each["digest"] != digest for each in same.values()):
            same = {test: {"digest": digest, "trace": trace} for test, trace in _trace(tests, folders, seconds).items()}
        found |= same
        kept.write_text(json.dumps(known | found), encoding="utf-8")  # of files so far, should the run be ended
    kept.write_text(json.dumps(found), encoding="utf-8")
    return read_traces(kept)


def read_traces(kept: Path) -> dict[str, Trace]:
    """What is known of tests, by their ids, from a file of `traces`."""
    known = json.loads(kept.read_text(encoding="utf-8"))
    return {test: Trace(**each["trace"]) for test, each in known.items() if isinstance(each["trace"], dict)}


def left_out(kept: Path) -> dict[str, str]:
    """Why tests kill nothing, by their ids, from a file of `traces`."""
    known = json.loads(kept.read_text(encoding="utf-8"))
    return {test: each["trace"] for test, each in known.items() if isinstance(each["trace"], str)}


def _trace(items: list[pytest.Item], folders: list[str], seconds: float) -> dict[str, Any]:
    """Traces of the tests of a file, each as a dictionary, or why of those that fail or take too long.

    A fixture may serve several tests: what the fixtures of the file execute counts for each of its tests.  A test that
    ends its process is named, and the others are traced without it.
    """
    with tempfile.TemporaryDirectory() as folder:
        answer, current = Path(folder, "answer"), Path(folder, "current")
        process = fork(lambda: _write_traces(items, folders, seconds, answer, current), math.inf)
        status = os.waitstatus_to_exitcode(os.waitpid(process, 0)[1])
        if not status:
            return dict(json.loads(answer.read_text("utf-8")))
        deadly = current.read_text("utf-8") if current.exists() else ""
    if deadly not in {item.nodeid for item in items}:
        raise RuntimeError(f"Tracing {items[0].path} ended with status {status} outside its tests.")
    print(f"{deadly} ends its process with status {status} while it is traced, and kills no mutant.", flush=True)
    others = [item for item in items if item.nodeid != deadly]
    return {deadly: f"ends its process with status {status}"} | (_trace(others, folders, seconds) if others else {})


def _write_traces(items: list[pytest.Item], folders: list[str], seconds: float, answer: Path, current: Path) -> int:
    """Trace tests of a file in this process; the test under way is noted in a file."""
    silence()
    wanted = [f"{SOURCE / folder}{below}" for folder in folders for below in ("", "/*", "/**/*")]
    tool = coverage.Coverage(data_file=None, config_file=False, include=wanted)
    tool.start()
    durations = _durations(items, seconds, current)
    tool.stop()
    warnings.simplefilter("ignore")  # a file may execute nothing of the folders
    lines = _lines(tool.get_data())
    traced = {
        test: {"duration": duration, "lines": _joined(lines[SETUP], lines[test])}
        if isinstance(duration, float)
        else duration
        for test, duration in durations.items()
    }
    answer.write_text(json.dumps(traced), "utf-8")
    return 0


def _durations(items: list[pytest.Item], seconds: float, current: Path) -> dict[str, float | str]:
    """Run tests; give the processor time of each, or why it fails, as where it needs more than that many seconds."""

    def stop(*_: object) -> None:
        raise TimeoutError

    signal.signal(signal.SIGXCPU, stop)
    durations: dict[str, float | str] = {}
    for item, following in zip(items, [*items[1:], None], strict=True):
        current.write_text(item.nodeid, "utf-8")
        begun, failed = time.process_time(), item.session.testsfailed
        resource.setrlimit(resource.RLIMIT_CPU, (math.ceil(begun + seconds), resource.RLIM_INFINITY))
        item.config.hook.pytest_runtest_protocol(item=item, nextitem=following)
        if item.session.testsfailed == failed:
            durations[item.nodeid] = time.process_time() - begun
        else:
            durations[item.nodeid] = reason_of_failure(item)
    return durations


def _lines(data: coverage.CoverageData) -> defaultdict[str, dict[str, list[int]]]:
    """Executed lines by context and file."""
    found: defaultdict[str, dict[str, list[int]]] = defaultdict(dict)
    for path in data.measured_files():
        file = Path(path).relative_to(ROOT).as_posix()
        for line, contexts in data.contexts_by_lineno(path).items():
            for context in contexts:
                found[context].setdefault(file, []).append(line)
    return found


def _joined(one: dict[str, list[int]], other: dict[str, list[int]]) -> dict[str, list[int]]:
    return {file: sorted({*one.get(file, []), *other.get(file, [])}) for file in one | other}


def _digest(*paths: Path) -> str:
    return hashlib.sha256(b"".join(path.read_bytes() for path in paths)).hexdigest()[:16]

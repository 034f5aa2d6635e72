"""Compilation of the kernels of a simulation: once per machine, then loaded from disk.

Steady running, the solution of the equations of motion, and observation take a third of the compilation each; where
there is a second core, a second process does a part of it meanwhile.
"""

import os
import pickle
import subprocess
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager, nullcontext
from pathlib import Path
from tempfile import TemporaryFile
from threading import Thread
from typing import BinaryIO

import numpy as np

from beltdyn.kernel import (
    CACHE_VARIABLE,
    compiles_quickly,
    holds_kernels,
    kernel_cache,
    report_compilation,
    runs_compiled,
    watch_compilation,
)
from beltdyn.observation.band_limit import compile_filter
from beltdyn.results.belt_history import fill_mid_spans
from beltdyn.results.friction_work import ARC_PARTS, Touch, WorkSoFar, add_friction_work
from beltdyn.solvers.engine import accelerate
from beltdyn.system.arrays import System
from beltdyn.system.observe import observe
from beltdyn.system.state import State
from beltdyn.system.steady_assembly import new_equations, no_multipliers

_SECOND = f"import sys; from {__name__} import run_for_another; run_for_another(sys.stdin.buffer)"


def usable_cores() -> int:
    """Number of cores that this process may use."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


def compile_kernels(system: System, state: State) -> None:
    """Call every kernel that static equilibrium, generalized-alpha and observation need, on no work at all."""
    with ahead(compile_solving, system, state):
        compile_observing(system)
    compile_solving(system, state)


def compile_run(system: System, state: State) -> None:
    """The same, in this process alone."""
    compile_solving(system, state)
    compile_observing(system)


def compile_observing(system: System) -> None:
    """Compile what observes states and derives results from them."""
    _compile_looking(system)
    _compile_recording()


def compile_for_rest(system: System, state: State) -> None:
    """Call the kernels that static equilibrium needs."""
    with ahead(compile_solving, system, state):
        _compile_looking(system)
    compile_solving(system, state)


def rest_is_compiled(system: System, state: State) -> bool:
    """Whether static equilibrium needs no compilation."""
    if not holds_kernels(kernel_cache()):
        return False  # without the import of Numba
    return runs_compiled(_compile_looking, system) and runs_compiled(compile_solving, system, state)


def _compile_looking(system: System) -> None:
    observe(system, np.empty(0), np.empty((0, 0)), np.empty((0, 0)))


def _compile_recording() -> None:
    time, states, places = np.empty(0), np.empty((0, 0)), np.empty((0, 0, 2))
    shown, touched = np.empty(0, dtype=np.bool_), np.empty((0, 0), dtype=np.int8)
    touch, work = Touch(time, places, places, touched, states), np.empty((0, 0, ARC_PARTS + 1))
    done = WorkSoFar(np.empty((2, 0, 0)), states)
    add_friction_work(touch, np.empty((0, 0, 3)), time, time, shown, done, work)
    fill_mid_spans(np.empty((0, 0, 2, 2)), places, np.empty((0, 0), dtype=np.int64), False, states)
    compile_filter()


def compile_solving(system: System, state: State) -> None:
    """Compile what solves the equations of motion alone; arguments as for `compile_kernels`."""
    motion = State(state.position, np.zeros_like(state.position), np.zeros_like(state.position)).at(0.0)
    accelerate(system, motion, no_multipliers(system), new_equations(system))


def run_for_another(arguments: BinaryIO) -> None:
    """Call a pickled function with its arguments in a process of its own, which prints its progress of compilation."""

    def report(done: int, total: int) -> None:
        sys.stdout.write(f"{done} {total}\n")
        sys.stdout.flush()

    with watch_compilation(report), _helped():
        function, *values = pickle.load(arguments)
        function(*values)


def _report(process: "subprocess.Popen[str]") -> None:
    """Report the progress that a process prints, up to its end."""
    assert process.stdout is not None
    total = 0
    with process.stdout as lines:
        for line in lines:
            if line.endswith("\n"):  # a killed process may leave half of one
                done, total = map(int, line.split())
                report_compilation(process.pid, done, total)
    report_compilation(process.pid, total, total)  # where it failed, this process compiles them


@contextmanager
def ahead(function: Callable[..., object], system: System, *others: object) -> Iterator[None]:
    """Let another process compile meanwhile what is needed next, where that is not compiled; see `beside`.

    Kernels depend on the classes of elements, laws and surfaces, so that the other process needs the system.
    """
    kind = function, classes_in(system)
    if _helps or kind in _compiled:
        yield
        return
    _compiled.add(kind)
    with nullcontext() if _is_compiled(function, system, *others) else beside(function, system, *others):
        yield


def classes_in(group: tuple[object, ...]) -> tuple[object, ...]:
    """Classes of a tuple and of the tuples in it, by which kernels differ."""
    return type(group), *(classes_in(part) for part in group if isinstance(part, tuple))


_compiled = set[tuple[object, ...]]()
"""What has been asked for: one process does not ask twice, though other kinds of machines need other kernels."""
_helps = list[None]()
"""Filled while another process compiles for this one, and in that process: there are no more than two."""


def _is_compiled(function: Callable[..., object], *arguments: object) -> bool:
    """Whether a function needs no compilation; plain compilation does not say, and counts as done if it has begun."""
    if not holds_kernels(kernel_cache()):
        return False
    return not compiles_quickly() or runs_compiled(function, *arguments)


@contextmanager
def _helped() -> Iterator[None]:
    _helps.append(None)
    try:
        yield
    finally:
        _helps.pop()


def _runs_python(executable: str) -> bool:
    """Whether a program is an interpreter: one that embeds Python, as hosts of units do, would start itself again."""
    return Path(executable or "").name.lower().startswith(("python", "pypy"))


@contextmanager
def beside(function: Callable[..., object], *arguments: object) -> Iterator[None]:
    """Call a function that compiles kernels in another process meanwhile, where there is a second core.

    If it fails, this process compiles them later. Arguments must be picklable.
    """
    if usable_cores() < 2 or not _runs_python(sys.executable):
        yield
        return
    with TemporaryFile() as call:
        pickle.dump((function, *arguments), call)
        call.seek(0)
        process = subprocess.Popen(
            [sys.executable, "-P", *["-O"] * sys.flags.optimize, "-c", _SECOND],
            env={
                **os.environ,
                CACHE_VARIABLE: str(kernel_cache().parent),
                "PYTHONPATH": os.pathsep.join(filter(None, sys.path)),
            },
            stdin=call,
            stdout=subprocess.PIPE,
            stderr=subprocess.DEVNULL,
            text=True,
        )
    reader = Thread(target=_report, args=(process,), daemon=True)
    reader.start()
    try:
        with _helped():
            yield
        process.wait()
    finally:
        process.kill()
        process.wait()
        reader.join()

"""How processes are started that compute beside this one."""

import multiprocessing
import os
import signal
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from threading import current_thread, main_thread
from types import ModuleType

SPAWN = multiprocessing.get_context("spawn")
_THREADS = "OMP_NUM_THREADS"
"""What OpenBLAS and MKL ask for their number of threads."""


@contextmanager
def bare_workers() -> Iterator[None]:
    """Let processes that are started meanwhile inherit little.

    They ignore Ctrl-C, of which the parent tells them; use one thread for linear algebra unless the user chose a
    number; and see an empty script in place of the caller's, which each of them would run otherwise.
    """
    script, threads = sys.modules["__main__"], os.environ.get(_THREADS)
    in_main_thread = current_thread() is main_thread()
    handler = signal.signal(signal.SIGINT, signal.SIG_IGN) if in_main_thread else None
    sys.modules["__main__"] = ModuleType("__main__")
    os.environ.setdefault(_THREADS, "1")
    try:
        yield
    finally:
        sys.modules["__main__"] = script
        if threads is None:
            del os.environ[_THREADS]
        if in_main_thread:
            signal.signal(signal.SIGINT, handler)

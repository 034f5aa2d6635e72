"""The process that computes numbers for the tabs, so that the page does not block."""

import asyncio
import multiprocessing
import threading
from concurrent.futures import Future, ProcessPoolExecutor
from concurrent.futures.process import BrokenProcessPool
from multiprocessing.context import SpawnProcess
from multiprocessing.process import BaseProcess

from beltdyn.app.computing import Answer, Asked, answer, begin, compile_ahead


class Calculator:
    """A process that answers requests one after another, started with the first."""

    def __init__(self) -> None:
        self._spawning = multiprocessing.get_context("spawn")
        self._compiles, self._compiles_ahead = self._spawning.Event(), self._spawning.Event()
        self._pool: ProcessPoolExecutor | None = None
        self._ahead: SpawnProcess | None = None
        self._starting = threading.Lock()

    @property
    def preparing(self) -> bool:
        """Whether kernels are being compiled."""
        return self._compiles.is_set() or self._compiles_ahead.is_set()

    def look_ahead(self, asked: Asked) -> None:
        """Load or compile kernels in advance.

        What a drive at rest needs is loaded by the process that answers; running and modes are left to one of their
        own, which begins when the drive is at rest.

        Parameters
        ----------
        asked : Asked
            A question about a drive at rest.
        """
        pool = self._process()

        def go_on(found: Future[Answer]) -> None:
            with self._starting:
                if self._pool is pool and not found.cancelled() and found.exception() is None:
                    self._ahead = self._spawning.Process(
                        target=compile_ahead, args=(asked, self._compiles_ahead), daemon=True
                    )
                    self._ahead.start()

        pool.submit(answer, asked).add_done_callback(go_on)

    def _process(self) -> ProcessPoolExecutor:
        if self._pool is None:
            self._pool = ProcessPoolExecutor(1, self._spawning, begin, (self._compiles,))
        return self._pool

    async def ask(self, asked: Asked) -> Answer:
        """Compute the numbers of a tab.

        Parameters
        ----------
        asked : Asked
            The question.

        Returns
        -------
        Answer
            Of a process that ended before it was done, as for want of memory, it says so; the next one is asked anew.
        """
        try:
            return await asyncio.get_running_loop().run_in_executor(self._process(), answer, asked)
        except BrokenProcessPool:
            self.close()
            return Answer((), (), "the computing process ended unexpectedly. Any change of the drive restarts it.", 0.0)

    def close(self) -> None:
        """End the processes at once, before resources shared with them are released."""
        with self._starting:
            pool, self._pool = self._pool, None
            ahead, self._ahead = self._ahead, None
        processes: list[BaseProcess] = [] if ahead is None else [ahead]
        if pool is not None:
            processes += (pool._processes or {}).values()
            pool.shutdown(wait=False, cancel_futures=True)
        for process in processes:
            process.kill()
        for process in processes:
            process.join()
        self._compiles.clear()
        self._compiles_ahead.clear()

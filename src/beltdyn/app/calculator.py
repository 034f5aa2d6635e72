"""The process that computes numbers for the tabs, so that the page never waits."""

import asyncio
import multiprocessing
from concurrent.futures import ProcessPoolExecutor
from concurrent.futures.process import BrokenProcessPool

from beltdyn.app.computing import Answer, Asked, answer, prepare


class Calculator:
    """A process that answers one question after the other; it is started with the first."""

    def __init__(self) -> None:
        self._pool: ProcessPoolExecutor | None = None

    async def ask(self, asked: Asked) -> Answer:
        """Compute what a tab wants to know.

        Parameters
        ----------
        asked : Asked
            The question.

        Returns
        -------
        Answer
            Of a process that ended before it was done, as for want of memory, it says so; the next one is asked anew.
        """
        if self._pool is None:
            spawning = multiprocessing.get_context("spawn")
            self._pool = ProcessPoolExecutor(max_workers=1, mp_context=spawning, initializer=prepare)
        try:
            return await asyncio.get_running_loop().run_in_executor(self._pool, answer, asked)
        except BrokenProcessPool:
            self.close()
            return Answer(
                (), (), "the process that computes has ended unexpectedly. Change something to start it anew.", 0.0
            )

    def close(self) -> None:
        """End the process, whatever it is at."""
        pool, self._pool = self._pool, None
        if pool is not None:
            processes = list((pool._processes or {}).values())
            pool.shutdown(wait=False, cancel_futures=True)
            for process in processes:
                process.kill()

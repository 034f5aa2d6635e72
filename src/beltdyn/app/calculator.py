"""The process that computes numbers for the tabs, so that the page never waits."""

import asyncio
import multiprocessing
from concurrent.futures import ProcessPoolExecutor
from concurrent.futures.process import BrokenProcessPool

from beltdyn.app.computing import Answer, Asked, Preparations, answer, begin, look_ahead


class Calculator:
    """A process that answers one question after the other; it is started with the first."""

    def __init__(self) -> None:
        self._spawning = multiprocessing.get_context("spawn")
        self._preparations = Preparations(self._spawning.Event(), self._spawning.Event())
        self._pool: ProcessPoolExecutor | None = None

    @property
    def preparing(self) -> bool:
        """Whether kernels are compiled, which answers may wait for."""
        return any(flag.is_set() for flag in self._preparations)

    def look_ahead(self, asked: Asked) -> None:
        """Start the process before there is a question, with a drive for which it makes its kernels ready.

        Parameters
        ----------
        asked : Asked
            A question about a drive at rest.
        """
        self._process().submit(look_ahead, asked)

    def _process(self) -> ProcessPoolExecutor:
        if self._pool is None:
            self._pool = ProcessPoolExecutor(1, self._spawning, begin, (self._preparations,))
        return self._pool

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
        try:
            return await asyncio.get_running_loop().run_in_executor(self._process(), answer, asked)
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
        for flag in self._preparations:
            flag.clear()

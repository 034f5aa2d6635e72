"""When kernels are compiled: once on a machine, for up to a minute, in which the page has to say what it waits for."""

from collections.abc import Callable

PREPARING = "preparing kernels (compiled once on a machine, for up to a minute)"
"""What is said meanwhile."""


def tell_of_compilation(tell: Callable[[bool], None]) -> None:
    """Tell from now on when this process compiles.

    Parameters
    ----------
    tell : callable
        Is called with True when compilation begins, and with False when it ends. Kernels that come from the disk are
        not told of.
    """
    from numba.core.event import Event, Listener, register

    class Teller(Listener):  # type: ignore[misc]
        """Counts the functions that are being compiled: those that a function calls are compiled within it."""

        depth = 0

        def on_start(self, event: Event) -> None:
            self.depth += 1
            if self.depth == 1:
                tell(True)

        def on_end(self, event: Event) -> None:
            self.depth -= 1
            if self.depth == 0:
                tell(False)

    register("numba:compile", Teller())

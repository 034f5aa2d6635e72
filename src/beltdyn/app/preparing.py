"""Tell the page when Numba compiles kernels."""

from collections.abc import Callable

PREPARING = "compiling kernels (once per machine, up to a minute)"
"""The state shown meanwhile."""


def tell_of_compilation(tell: Callable[[bool], None]) -> None:
    """Report compilation of this process from now on.

    Parameters
    ----------
    tell : callable
        Is called with True when compilation begins, and with False when it ends. Kernels that come from the disk are
        not told of.
    """
    from numba.core.event import Event, Listener, register

    class Teller(Listener):  # type: ignore[misc]
        """Counts functions being compiled, with nested calls."""

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

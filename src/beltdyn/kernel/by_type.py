"""Compile-time dispatch on the first argument's type."""

from abc import ABC, abstractmethod
from collections.abc import Callable, Iterable, Mapping
from functools import cached_property
from typing import Any, ClassVar

from beltdyn.kernel.fingerprint import compiles_quickly


class Dispatch(ABC):
    """Several kernels with one name."""

    unregistered: ClassVar[list["Dispatch"]] = []
    """Those not yet registered with plain compilation."""

    def __init__(self, name: str) -> None:
        self.__name__ = name
        self.unregistered.append(self)

    @abstractmethod
    def kernel_for(self, subject: Any, *_rest: Any) -> Any:
        """The kernel for a Numba type of the first argument."""

    @abstractmethod
    def kernels_for(self, classes: frozenset[type]) -> Iterable[Any]:
        """The kernels that it may call in kernels whose arguments are of some classes of named tuples."""

    @property
    def _numba_type_(self) -> Any:
        """Type by which kernels know this choice; plain compilation asks `numba.extending` instead."""
        if not compiles_quickly():
            raise AttributeError("_numba_type_")
        return self._quick_type

    @cached_property
    def _quick_type(self) -> Any:
        from beltdyn.kernel.quick import choice_type

        return choice_type(self.kernel_for)


class ByType(Dispatch):
    """Kernels for classes of named tuples; classes may be added later."""

    def __init__(self, kernels: Mapping[type, Callable[..., Any]], name: str) -> None:
        super().__init__(name)
        self.kernels: Mapping[Any, Any] = kernels

    def __call__(self, subject: Any, *rest: Any) -> Any:
        """Call the kernel for the type of the first argument."""
        return self.kernels[type(subject)](subject, *rest)

    def kernel_for(self, subject: Any, *_rest: Any) -> Any:
        """The kernel for a Numba type of the first argument."""
        chosen = self.kernels.get(getattr(subject, "instance_class", None))
        if chosen is None:
            known = ", ".join(kind.__name__ for kind in self.kernels)
            raise TypeError(f"{self.__name__} takes {known}, not {subject}. Register a kernel for it.")
        return chosen

    def kernels_for(self, classes: frozenset[type]) -> Iterable[Any]:
        """Those of the classes."""
        return [kernel for kind, kernel in self.kernels.items() if kind in classes]


def by_type(kernels: Mapping[type, Callable[..., Any]], name: str) -> Callable[..., Any]:
    """Combine several kernels under one name, chosen by the type of the first argument.

    Where a kernel calls it, the choice is made as the caller is compiled, for the types of its arguments; it costs
    nothing at run time, and what is not chosen is not compiled.

    Examples
    --------
    >>> from typing import NamedTuple
    >>> from beltdyn.kernel import by_type, kernel
    >>> class Disc(NamedTuple):
    ...     radius: float
    >>> class Square(NamedTuple):
    ...     side: float
    >>> @kernel
    ... def disc_area(disc):
    ...     return 3.14159 * disc.radius**2
    >>> @kernel
    ... def square_area(square):
    ...     return square.side**2
    >>> area = by_type({Disc: disc_area, Square: square_area}, "area")
    >>> area(Square(2.0))
    4.0
    """
    return ByType(kernels, name)

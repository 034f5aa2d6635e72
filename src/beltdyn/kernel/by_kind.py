"""Dispatch of a row of a table to the kernel of its kind."""

from collections.abc import Callable, Iterable, Mapping, Sequence
from typing import Any

from beltdyn.kernel.by_type import Dispatch
from beltdyn.kernel.decorator import Kernel


class ByKind(Dispatch):
    """Kernels for the kinds that a row has room for, one of which its field `kind` chooses at run time."""

    def __init__(self, name: str, functions: Mapping[str, Callable[..., Any]], others: Sequence[str]) -> None:
        super().__init__(name)
        self._functions, self._others = functions, ", ".join(others)
        self._chains: dict[tuple[str, ...], Kernel[..., Any]] = {}

    def __call__(self, row: Any, *rest: Any) -> Any:
        """Call the kernel of the kind of a row."""
        return self._chain(row.dtype.names)(row, *rest)

    def kernel_for(self, subject: Any, *_rest: Any) -> Any:
        """The kernel for a Numba type of a row."""
        return self._chain(subject.fields)

    def kernels_for(self, _classes: frozenset[type]) -> Iterable[Any]:
        """Those of all kinds: the fields of a row say which, not its class."""
        return self._functions.values()

    def _chain(self, fields: Any) -> Kernel[..., Any]:
        """The kernel for a row with some fields, which counts the kinds in their order."""
        kinds = tuple(name for name in fields if name in self._functions)
        if kinds not in self._chains:
            self._chains[kinds] = self._written(kinds)
        return self._chains[kinds]

    def _written(self, kinds: tuple[str, ...]) -> Kernel[..., Any]:
        lines = [f"def {self.__name__}(row, {self._others}):"]
        for number, kind in enumerate(kinds):
            condition = f"if row.kind == {number}: " if number < len(kinds) - 1 else ""
            lines.append(f"    {condition}return of_{kind}(row.{kind}, {self._others})")
        namespace: dict[str, Any] = {f"of_{kind}": self._functions[kind] for kind in kinds}
        namespace["__name__"] = __name__
        exec(compile("\n".join(lines), __file__, "exec"), namespace)
        return Kernel(namespace[self.__name__], inline=True)


def choice(name: str, functions: Mapping[str, Callable[..., Any]], others: Sequence[str]) -> Callable[..., Any]:
    """Make a function that calls one of several kernels, by the field of the row that has the kind's constants."""
    return ByKind(name, functions, others)

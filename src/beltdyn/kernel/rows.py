"""Registries of kinds that have kernels, rows with their constants, and dispatch of a row to the kernel of its kind."""

from collections.abc import Callable, Iterable, Mapping, Sequence
from typing import Any, NamedTuple, TypeVar

import numpy as np

from beltdyn.arrays import fill, record
from beltdyn.errors import ModelError
from beltdyn.kernel.decorator import Kernel, forget_compiled
from beltdyn.kernel.dispatch import Dispatch
from beltdyn.kernel.fingerprint import compiles_quickly, declare, fingerprint
from beltdyn.kinds import Registry, name_of

K = TypeVar("K")


class _View(NamedTuple):
    """A table of kernels that grows with the registry."""

    attribute: str
    key: Callable[[Any], Any]
    where: Callable[[Any], bool]
    table: dict[Any, Any]


class KernelKinds(Registry[K]):
    """The kinds of a family whose functions are kernels, for `beltdyn.kernel.by_type` and `choice`.

    The label of a kind from outside the package has the fingerprint of its kernels, so that kernels which call an
    edited law of the same name are others.
    """

    def __init__(self, family: str, contract: type, record: str = "") -> None:
        super().__init__(family, contract)
        self._record = record
        self._labels: dict[int, tuple[K, str]] = {}
        self.labelled: dict[str, K] = {}
        """All kinds by their labels, replaced ones too."""
        self._views: list[_View] = []

    def label(self, kind: K) -> str:
        """Name of a kind, with a fingerprint where it comes from outside the package."""
        return self._labels[id(kind)][1]

    def add(self, kind: K, origin: str) -> None:
        """As for `Registry`; the functions of a kind must be kernels."""
        for view in self._views:
            self._require_kernel(kind, view)
        super().add(kind, origin)
        name, classes = name_of(kind), [getattr(kind, self._record)] if self._record else []
        own = self.is_own(name)
        label = f"{name}_{fingerprint([*kernels_of(kind), *classes])}" if own else name
        self._labels[id(kind)], self.labelled[label] = (kind, label), kind
        for view in self._views:
            self._enter(view, label, kind)
        for parameters in classes if own else ():
            declare(parameters, f"{self.family} {label}")
            if not compiles_quickly():
                forget_compiled()

    def functions(self, attribute: str, where: Callable[[K], bool] = lambda _: True) -> dict[str, Any]:
        """Kernels of the kinds by label; kinds that are registered later are added."""
        return self._table(attribute, None, where)

    def by_class(self, attribute: str) -> dict[type, Any]:
        """Kernels of the kinds by the class of their parameters; kinds that are registered later are added."""
        return self._table(attribute, lambda kind: getattr(kind, self._record), lambda _: True)

    def _table(self, attribute: str, key: Callable[[Any], Any] | None, where: Callable[[Any], bool]) -> dict[Any, Any]:
        view = _View(attribute, key or self.label, where, {})
        self._views.append(view)
        for label, kind in self.labelled.items():
            self._enter(view, label, kind)
        return view.table

    def _enter(self, view: _View, label: str, kind: K) -> None:
        if view.where(kind):
            view.table[view.key(kind)] = getattr(kind, view.attribute)

    def _require_kernel(self, kind: K, view: _View) -> None:
        if view.where(kind) and not isinstance(getattr(kind, view.attribute, None), Kernel):
            raise ModelError(
                f'the {self.family} "{name_of(kind)}" cannot be registered: {view.attribute} must be a kernel. '
                "Decorate its function with @kernel."
            )


def own_labels() -> list[str]:
    """Labels of all kinds with kernels from outside the package."""
    return [family.label(kind) for family in _families() for name, kind in family.items() if family.is_own(name)]


def _labels_here() -> list[str]:
    """Labels of all kinds with kernels that this process knows."""
    return [label for family in _families() for label in family.labelled]


def _families() -> list[KernelKinds[Any]]:
    return [family for family in Registry.families if isinstance(family, KernelKinds)]


def kernels_of(kind: Any) -> list[Kernel[..., Any]]:
    """Kernels of a kind: fields of an object, or attributes of a class and its bases."""
    holders = kind.__mro__ if isinstance(kind, type) else [kind]
    values = [value for holder in holders for value in _attributes(holder)]
    return [value for value in values if isinstance(value, Kernel)]


def _attributes(holder: Any) -> Iterable[Any]:
    return holder if isinstance(holder, tuple) else vars(holder).values()


class KindRows:
    """Rows with constants of one of several kinds; a user's kind changes the type of a row only in drives that have it.

    After the `fields` of all rows, `kind` has the place of the kind among the constants.
    """

    def __init__(
        self,
        kinds: KernelKinds[Any],
        constants: Callable[[Any], np.dtype[np.void] | None],
        **fields: str | np.dtype[np.void],
    ) -> None:
        self._kinds, self._constants, self._fields = kinds, constants, fields

    def row_type(self, used: Iterable[Any] = ()) -> np.dtype[np.void]:
        """Type of the rows for some kinds."""
        own = dict.fromkeys(kind for kind in used if self._kinds.is_own(name_of(kind)))
        kinds = (*(kind for name, kind in self._kinds.items() if not self._kinds.is_own(name)), *own)
        constants = {self._kinds.label(kind): self._constants(kind) for kind in kinds}
        known = {label: kind for label, kind in constants.items() if kind is not None}
        return record(**self._fields, kind="i8", **known)

    def fill(self, row: np.record, kind: Any, values: Mapping[str, Any]) -> None:
        """Set the kind of a row, and its constants."""
        label = self._kinds.label(kind)
        row.kind = labels(row.dtype).index(label)
        fill(row[label], values)


def labels(row_type: np.dtype[np.void]) -> list[str]:
    """Fields of the constants of the kinds of a row, in their order."""
    names = list(row_type.names or ())
    return names[names.index("kind") + 1 :]


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
            names = list(fields)
            unknown = sorted({*names[names.index("kind") + 1 :]} - {*self._functions, *_labels_here()})
            if unknown:  # a process that has not imported their module would take their rows for those of other kinds
                raise TypeError(f"{self.__name__} knows no kind {', '.join(unknown)}. Import the module of its class.")
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

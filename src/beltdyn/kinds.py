"""Kinds of laws, elements, machines and analyses: a registry for each family, and the call that adds a kind to it."""

import re
import sys
from collections.abc import Callable, Iterator, Mapping
from typing import Any, ClassVar, Generic, NamedTuple, TypeVar, get_args

from beltdyn.errors import ModelError

K = TypeVar("K")
_PACKAGE = "beltdyn"
_NAME = re.compile(r"[A-Za-z][\w-]*")


class Parameter(NamedTuple):
    """A number that a law or a surface takes, as a key of a drive file.

    It is required where its law is chosen, unless it has a default or the drive chooses it, and refused elsewhere.
    """

    name: str
    """The key, and the name of the field in the record of the law."""
    unit: str
    """SI unit as a user writes it, "kg/(m*s)"; empty for a ratio."""
    meaning: str
    """Its description, before the unit."""
    above: float | None = 0.0
    """Its lower bound; None for any number."""
    default: float | None = None
    """Its default."""
    found: bool = False
    """Whether a drive chooses its default."""
    example: float | None = None
    """A usual value, for forms and tests."""


class Registry(Mapping[str, K], Generic[K]):
    """The kinds of a family by name, in the order of their registration."""

    families: ClassVar[list["Registry[Any]"]] = []
    """All registries."""

    def __init__(self, family: str, contract: type) -> None:
        self.family, self.contract = family, contract
        self.origins: dict[str, str] = {}
        """The module that registered each kind."""
        self._kinds: dict[str, K] = {}
        self._checks: list[Callable[[K], None]] = []
        self._watchers: list[Callable[[], None]] = []
        self.families.append(self)

    def __getitem__(self, name: str) -> K:
        return self._kinds[name]

    def __iter__(self) -> Iterator[str]:
        return iter(self._kinds)

    def __len__(self) -> int:
        return len(self._kinds)

    def add(self, kind: K, origin: str) -> None:
        """Add a kind that a module registers; one of the same name from outside the package is replaced."""
        name = name_of(kind)
        if not _NAME.fullmatch(name):
            raise ModelError(
                f'the {self.family} "{name}" cannot be registered: its name must begin with a letter and consist of '
                "letters, digits and underscores. Rename it."
            )
        if name in self._kinds and not self.is_own(name):
            raise ModelError(
                f'the {self.family} "{name}" cannot be registered: beltdyn has one of this name. Rename yours.'
            )
        for key in _shadowing(kind, self.contract):
            raise ModelError(
                f'the {self.family} "{name}" cannot be registered: its key {key} has the name of an attribute of '
                f"{self.contract.__name__}. Rename it."
            )
        for check in self._checks:
            check(kind)
        self._kinds[name], self.origins[name] = kind, origin
        for watch in self._watchers:
            watch()

    def forget(self, name: str) -> None:
        """Remove a kind that was registered from outside the package."""
        if not self.is_own(name):
            raise ModelError(f'the {self.family} "{name}" belongs to beltdyn and cannot be removed. Name one of yours.')
        del self._kinds[name]
        for watch in self._watchers:
            watch()

    def is_own(self, name: str) -> bool:
        """Whether a kind was registered from outside the package."""
        return self.origins[name].partition(".")[0] != _PACKAGE

    def check(self, rule: Callable[[K], None]) -> None:
        """Have a rule raise `ModelError` for kinds that cannot be registered."""
        self._checks.append(rule)

    def watch(self, watcher: Callable[[], None], *, first: bool = False) -> None:
        """Call a function after each registration, before others or behind them."""
        if watcher not in self._watchers:
            self._watchers.insert(0 if first else len(self._watchers), watcher)


def _shadowing(kind: Any, contract: type) -> list[str]:
    """Keys of a class that hide attributes of its base."""
    inherited = getattr(contract, "model_fields", {})
    return [key for key in getattr(kind, "model_fields", ()) if key not in inherited and hasattr(contract, key)]


def name_of(kind: Any) -> str:
    """Name of a kind: that of an object, or the only value of the field `kind` of a class."""
    if not isinstance(kind, type):
        return str(kind.name)
    values = get_args(kind.model_fields["kind"].annotation)  # type: ignore[attr-defined]
    return str(values[0])


def register(kind: K) -> K:
    """Add a kind to its family, for drive files, analyses and figures of this process; also a decorator of classes.

    Parameters
    ----------
    kind
        A `FrictionLaw`, `NormalLaw`, `SurfaceKind`, `StretchLaw`, `ElementKind`, `IntegratorKind` or `Analysis`, or a
        class derived from `Load`, `HubLink`, `Tensioner`, `Support` or `Profile`.

    Returns
    -------
    The kind itself.

    Raises
    ------
    ModelError
        If it belongs to no family, its name or a key is taken, or a function is not a kernel.
    """
    for registry in Registry.families:
        if isinstance(kind, registry.contract) or (isinstance(kind, type) and issubclass(kind, registry.contract)):
            registry.add(kind, str(sys._getframe(1).f_globals.get("__name__", "__main__")))
            return kind
    known = ", ".join(registry.contract.__name__ for registry in Registry.families)
    raise ModelError(f"{kind!r} cannot be registered: it belongs to no family of kinds. Make it one of {known}.")

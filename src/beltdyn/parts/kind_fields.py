"""Fields of a drive file that choose a kind, and those that the chosen kind has: they follow the registries.

A kind that is registered after parts were used changes their fields, and they are built anew.
"""

from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass
from functools import cache
from typing import Annotated, Any, Literal, NamedTuple, Union, get_args

from pydantic import Field
from pydantic.fields import FieldInfo

from beltdyn.errors import ModelError
from beltdyn.kinds import Parameter, Registry
from beltdyn.parts.part import Part, describe
from beltdyn.parts.quantity import quantity
from beltdyn.parts.text_file import forget_schemas


@dataclass(frozen=True, eq=False)
class NameOf:
    """Annotation of a field that names a kind, the default first."""

    kinds: Registry[Any]
    default: str = ""

    def __post_init__(self) -> None:
        follow(self.kinds)

    @property
    def choices(self) -> tuple[str, ...]:
        """The names."""
        return tuple(sorted(self.kinds, key=lambda name: name != self.default))

    def __get_pydantic_core_schema__(self, _source: Any, handler: Any) -> Any:
        return handler.generate_schema(Literal[self.choices])


@dataclass(frozen=True, eq=False)
class OneOf:
    """Annotation of a field for a part of any kind."""

    kinds: Registry[Any]
    part: Callable[[Any], Any] = lambda kind: kind
    """The part of a kind, which by default is the kind itself."""
    where: Callable[[Any], bool] = lambda _: True
    """Which kinds are meant."""

    def __post_init__(self) -> None:
        follow(self.kinds)

    @property
    def parts(self) -> tuple[Any, ...]:
        """The classes of the kinds."""
        return tuple(map(self.part, filter(self.where, self.kinds.values())))

    def __get_pydantic_core_schema__(self, _source: Any, handler: Any) -> Any:
        return handler.generate_schema(Annotated[Union[self.parts], Field(discriminator="kind")])  # noqa: UP007


class Chosen(NamedTuple):
    """A kind that a part names, or that one of its inner parts is."""

    kinds: Registry[Any]
    name: str

    @property
    def is_own(self) -> bool:
        """Whether it was registered from outside the package."""
        return self.kinds.is_own(self.name)

    @property
    def origin(self) -> str:
        """The module that registered it."""
        return self.kinds.origins[self.name]

    def __str__(self) -> str:
        return f'{self.kinds.family} "{self.name}"'


def chosen_kinds(part: Part) -> Iterator[Chosen]:
    """Kinds that a part and its inner parts have."""
    for name, registries in _choices(type(part)).items():
        value = getattr(part, name)
        values = value if isinstance(value, tuple) else (value,)
        for kinds in registries:
            names = (getattr(one, "kind", one) for one in values)
            yield from (Chosen(kinds, str(one)) for one in names if one is not None)
        for inner in values:
            if isinstance(inner, Part):
                yield from chosen_kinds(inner)


def refuse_kinds_of_scripts(chosen: Iterable[Chosen]) -> None:
    """Make sure that other processes can import the modules that register kinds."""
    for kind in chosen:
        if kind.origin == "__main__":
            raise ModelError(
                f"the {kind} is registered by the script itself, which other processes do not run. Move it to a module "
                "beside the script and import that, or run the drive in this process."
            )


@cache
def _choices(part: type[Part]) -> dict[str, tuple[Registry[Any], ...]]:
    """Registries from which each field of a part chooses, until a kind is registered."""
    fields = part.model_fields.items()
    return {name: tuple(_registries((field.annotation, *field.metadata))) for name, field in fields}


def _registries(annotations: Iterable[Any]) -> Iterator[Registry[Any]]:
    """Registries from which annotations choose."""
    for one in annotations:
        if isinstance(one, NameOf | OneOf):
            yield one.kinds
        else:
            yield from _registries(get_args(one))


# Parts are built anew after a registration, the inner ones first


def follow(kinds: Registry[Any]) -> None:
    """Let parts follow the registrations of a family."""
    kinds.watch(_build_anew)


def _build_anew() -> None:
    """Build all parts that are in use anew."""
    done = set[Any]()
    forget_schemas()
    _choices.cache_clear()
    for part in [part for part in _parts(Part) if part.__pydantic_complete__]:
        _build(part, done)


def _build(part: Any, done: set[Any]) -> None:
    if part in done:
        return
    done.add(part)
    for field in part.model_fields.values():
        for inner in _inner((field.annotation, *field.metadata)):
            _build(inner, done)
    if part.__pydantic_complete__:
        part.model_rebuild(force=True)
    describe(part)


def _inner(annotations: Iterable[Any]) -> Iterator[Any]:
    """Parts in some annotations."""
    for one in annotations:
        if isinstance(one, OneOf):
            yield from one.parts
        elif isinstance(one, type) and issubclass(one, Part):
            yield one
        else:
            yield from _inner(get_args(one))


def _parts(part: Any) -> Iterator[Any]:
    for one in part.__subclasses__():
        yield one
        yield from _parts(one)


# Keys of the laws that a part names

_ENTERED: dict["LawKeys", tuple[str, ...]] = {}
"""Keys that parts have from laws."""


@dataclass(frozen=True, eq=False)
class LawKeys:
    """The parameters of a law family as keys of a part, whose field `key` names the law."""

    part: type[Part]
    key: str
    laws: Registry[Any]

    def __post_init__(self) -> None:
        own = set(self.part.keys())
        self._enter()
        self.laws.check(lambda law: self._refuse_other_keys(law, own))
        self.laws.watch(self._enter, first=True)
        follow(self.laws)

    def _refuse_other_keys(self, law: Any, own: set[str]) -> None:
        for parameter in law.parameters:
            if parameter.name in own:
                raise ModelError(
                    f'the {self.laws.family} "{law.name}" cannot be registered: {parameter.name} is another key of '
                    f"[{self.part.__name__.lower()}]. Rename it."
                )

    def _enter(self) -> None:
        """Put the keys of all laws behind the field that names one."""
        fields, before = self.part.model_fields, _ENTERED.get(self, ())
        keys = {one.name: key_field(one, optional=True) for law in self.laws.values() for one in law.parameters}
        others = {name: field for name, field in fields.items() if name not in before}
        fields.clear()
        for name, field in others.items():
            fields |= {name: field} | (keys if name == self.key else {})
        for name in keys:
            setattr(self.part, name, None)  # of parts that were made before
        _ENTERED[self] = tuple(keys)
        describe(self.part)

    def check(self, part: Part) -> None:
        """Make sure that a part has the keys of its law, and no other's."""
        chosen = getattr(part, self.key)
        family = self.laws.family
        own = {parameter.name: parameter for parameter in self.laws[chosen].parameters}
        for key, owner in ((key.name, law.name) for law in self.laws.values() for key in law.parameters):
            if key not in own and getattr(part, key) is not None:
                raise ValueError(
                    f'{key} belongs to the {family} "{owner}", not to "{chosen}". Remove it, or set '
                    f'{self.key} = "{owner}"'
                )
        for key, parameter in own.items():
            if getattr(part, key) is None and parameter.default is None and not parameter.found:
                raise ValueError(f'{key} is missing, but the {family} "{chosen}" needs it. Give {key}')

    @property
    def names(self) -> tuple[str, ...]:
        """The keys of all laws."""
        return tuple(dict.fromkeys(one.name for law in self.laws.values() for one in law.parameters))


def key_field(parameter: Parameter, *, optional: bool = False) -> FieldInfo:
    """Field of a parameter."""
    meaning = f"{parameter.meaning}, in {parameter.unit}" if parameter.unit else parameter.meaning
    number: Any = Annotated[float, quantity(parameter.unit)]
    examples = None if parameter.example is None else [parameter.example]
    default = None if optional else ... if parameter.default is None else parameter.default
    made: Any = Field(default, gt=parameter.above, description=meaning, examples=examples)
    return FieldInfo.from_annotated_attribute(number | None if optional else number, made)

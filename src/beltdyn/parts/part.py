"""The base class of all parts of a drive: immutable, validated, with clear error messages."""

import inspect
import textwrap
import types
import typing
from collections.abc import Iterator, Mapping
from functools import cache
from types import MappingProxyType
from typing import Annotated, Any, ClassVar, Literal, Self

from annotated_types import Ge, Gt, Le, Lt
from pydantic import (
    BaseModel,
    BeforeValidator,
    ConfigDict,
    ModelWrapValidatorHandler,
    PrivateAttr,
    ValidationError,
    model_validator,
)
from pydantic.fields import FieldInfo

from beltdyn.errors import ModelError
from beltdyn.parts.messages import explain
from beltdyn.parts.quantity import has_tolerance
from beltdyn.parts.text_file import entry_name

# Docstrings of the parts of a drive from their fields: meaning, unit, limits and default of each argument

_LINE_WIDTH = 100
"""Characters of a line of a docstring, at most: a choice for terminals."""
_EXAMPLES = "\n\nExamples\n--------\n"
"""Stands last in a docstring."""
_NAMES = {float: "float", int: "int", bool: "bool", str: "str"}


_OWN_WORDS: dict[type, str] = {}
"""Docstrings of parts as written."""


def describe(part: "type[Part]") -> None:
    """Give docstring and signature of a part the arguments that it takes now."""
    _OWN_WORDS.setdefault(part, inspect.cleandoc(part.__doc__ or ""))
    part.__doc__ = document(part, part.alternatives())
    part.__signature__ = signature(part, part.alternatives())
    part._optional.cache_clear()


def document(part: type[BaseModel], others: Mapping[str, FieldInfo]) -> str:
    """Docstring of a part with numpydoc sections of its constructor's arguments."""
    fields = {field.alias or name: field for name, field in part.model_fields.items()}
    told, heading, examples = _OWN_WORDS[part].partition(_EXAMPLES)
    return told + _section("Parameters", fields) + _section("Other Parameters", others) + heading + examples


def signature(part: type[BaseModel], others: Mapping[str, FieldInfo]) -> inspect.Signature:
    """Signature of the constructor of a part, for help and completion; arguments as for `document`."""
    fields = {field.alias or name: field for name, field in part.model_fields.items()}
    return inspect.Signature(
        [
            inspect.Parameter(name, inspect.Parameter.KEYWORD_ONLY, default=_default(field, bool(others)))
            for name, field in {**fields, **others}.items()
        ]
    )


def _default(field: FieldInfo, replaceable: bool) -> Any:
    """What a signature shows as default."""
    if not field.is_required():
        return field.get_default()
    return None if replaceable else inspect.Parameter.empty


def _section(title: str, fields: Mapping[str, FieldInfo]) -> str:
    """A section of the docstring; nothing without fields."""
    if not fields:
        return ""
    return "\n".join(["\n", title, "-" * len(title), *(_argument(name, field) for name, field in fields.items())])


def _argument(name: str, field: FieldInfo) -> str:
    """One entry: name, type and default, then the description with its limits."""
    optional = (
        ", optional" if field.default_factory or field.default in (None, ()) else f", default {_literal(field.default)}"
    )
    described = field.description or f"always {_literal(field.default)}"
    limits = " and ".join(limit for limit in map(_limit, field.metadata) if limit)
    sentence = f"{described[0].upper()}{described[1:]}." + (f"  {limits.capitalize()}." if limits else "")
    text = textwrap.fill(sentence, _LINE_WIDTH, initial_indent="    ", subsequent_indent="    ")
    return f"{name} : {_type(field.annotation, field.metadata)}{'' if field.is_required() else optional}\n{text}"


def _limit(constraint: object) -> str:
    """A limit in words; nothing of what is none."""
    match constraint:
        case Gt(gt=limit):
            return f"above {limit:g}"
        case Ge(ge=limit):
            return f"at least {limit:g}"
        case Lt(lt=limit):
            return f"below {limit:g}"
        case Le(le=limit):
            return f"at most {limit:g}"
    return ""


def _literal(value: object) -> str:
    """A default as it is written in Python."""
    return f'"{value}"' if isinstance(value, str) else repr(value)


def _choice(values: typing.Iterable[Any]) -> str:
    """A choice among values."""
    return "{" + ", ".join(map(_literal, values)) + "}"


def _type(annotation: Any, metadata: typing.Sequence[Any] = ()) -> str:
    """A type in words: what may be given, without None."""
    origin, inner = typing.get_origin(annotation), typing.get_args(annotation)
    if choices := next((one.choices for one in metadata if hasattr(one, "choices")), None):
        return _choice(choices)
    if isinstance(annotation, typing.TypeVar):
        return "float"
    if origin is Annotated:
        return _type(inner[0], inner[1:])
    if origin is Literal:
        return _choice(inner)
    if origin in (typing.Union, types.UnionType):
        named = [_type(one, metadata) for one in inner if one is not types.NoneType]
        return " or ".join(dict.fromkeys(named))
    if origin is tuple and inner[-1] is Ellipsis:
        return f"list of {_type(inner[0])}"
    if origin is tuple:
        return f"({', '.join(_type(one) for one in inner)})"
    with_unit = any(isinstance(one, BeforeValidator) and one.json_schema_input_type == float | str for one in metadata)
    name: str = _NAMES.get(annotation) or annotation.__name__.partition("[")[0]
    return name + " or text with a unit" * with_unit


def _first_key(path: str) -> str:
    """The first key of a path."""
    return path.replace("[", ".").partition(".")[0]


def _toleranced(given: Any, path: str) -> Iterator[tuple[str, str]]:
    """All texts with tolerances in what a part is made of, with their paths."""
    if isinstance(given, str) and has_tolerance(given):
        yield path, given
    elif isinstance(given, Mapping):
        for key, inner in given.items():
            yield from _toleranced(inner, f"{path}.{key}" if path else str(key))
    elif isinstance(given, list | tuple):
        for number, inner in enumerate(given, 1):
            if not isinstance(inner, int | float):  # of which long tables are made
                yield from _toleranced(inner, f"{path}[{entry_name(inner) or number}]")
    elif isinstance(given, Part):
        for inside, text in given.toleranced.items():
            yield f"{path}.{inside}", text


class Part(BaseModel):
    """A validated, immutable part of a drive; its constructor takes the keys of the file."""

    model_config = ConfigDict(
        frozen=True, extra="forbid", allow_inf_nan=False, hide_input_in_errors=True, defer_build=True
    )
    fills_a_file: ClassVar[bool] = False
    """Whether paths in messages begin with its keys, as in a file."""
    either: ClassVar[tuple[str, str] | None] = None
    """Pairs of arguments that determine each other."""
    in_place_of: ClassVar[Mapping[str, str]] = MappingProxyType({})
    """Arguments that are converted to another one, by name."""

    _toleranced: dict[str, str] = PrivateAttr(default_factory=dict)

    def __init__(self, **data: Any) -> None:
        try:
            super().__init__(**data)
        except ValidationError as error:
            raise ModelError(explain(error, type(self), data)) from None

    def __repr_args__(self) -> Any:
        """Arguments that differ from their defaults."""
        fields = type(self).model_fields
        return [(name, value) for name, value in super().__repr_args__() if value != fields[str(name)].get_default()]

    __str__ = BaseModel.__repr__

    @classmethod
    def keys(cls) -> list[str]:
        """Names of all constructor arguments."""
        return [*(field.alias or name for name, field in cls.model_fields.items()), *cls.alternatives()]

    @classmethod
    def alternatives(cls) -> Mapping[str, FieldInfo]:
        """Constructor arguments that replace fields, by name."""
        return {}

    @model_validator(mode="before")
    @classmethod
    def _leave_open(cls, data: Any) -> Any:
        """Take None for an argument that is left open."""
        if not isinstance(data, Mapping):
            return data
        return {name: value for name, value in data.items() if value is not None or name not in cls._optional()}

    @model_validator(mode="wrap")
    @classmethod
    def _keeps_tolerances(cls, data: Any, build: ModelWrapValidatorHandler[Self]) -> Self:
        part = build(data)
        if isinstance(data, Mapping):
            part._toleranced = dict(_toleranced(data, ""))
        return part

    @property
    def toleranced(self) -> dict[str, str]:
        """Numbers given as texts with tolerances, such as ``"12.5 ± 0.1 mm"``, by their paths."""
        return self._toleranced

    def take_over(self, toleranced: Mapping[str, str]) -> None:
        """Keep tolerances of the part from which this one is copied, where it has none of its own."""
        self._toleranced = {**toleranced, **self._toleranced}

    @classmethod
    @cache
    def _optional(cls) -> frozenset[str]:
        """Names of the arguments that may be left open."""
        fields = {field.alias or name: field for name, field in cls.model_fields.items()} | dict(cls.alternatives())
        return frozenset(name for name, field in fields.items() if field.default is None)

    @classmethod
    def __pydantic_init_subclass__(cls, **_: Any) -> None:
        """Tell of each argument in the docstring and in the signature."""
        describe(cls)

    @classmethod
    def __pydantic_on_complete__(cls) -> None:
        """Keep the signature, which pydantic makes anew when it builds the part for its first use."""
        cls.__signature__ = signature(cls, cls.alternatives())

    # Tells pydantic that parts inside parts need not go through this constructor, so that it reports
    # all errors of a drive at once, each with its path.
    __init__.__pydantic_base_init__ = True  # type: ignore[attr-defined]

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Part) and type(self) is type(other) and self.arguments == other.arguments

    def value_of(self, key: str) -> Any:
        """The value of a constructor argument, given or derived; None if it is open."""
        return self.arguments.get(key)

    @property
    def arguments(self) -> dict[str, Any]:
        """The constructor arguments of this part, without open ones."""
        values = {name: getattr(self, name) for name in type(self).model_fields}
        return {
            field.alias or name: values[name]
            for name, field in type(self).model_fields.items()
            if not (values[name] is None and field.default is None)
        }

    @property
    def following(self) -> tuple[str, ...]:
        """Arguments that follow from others, and cannot be changed alone."""
        return ()

    def replace(self, **changes: Any) -> Self:
        """Make a validated copy with some values changed.

        Examples
        --------
        >>> drive.belt.replace(elements=30).elements
        30
        """
        changed = type(self)(**self.merged(changes))
        meant = {self._meant(key) for key in changes}
        changed.take_over({p: text for p, text in self.toleranced.items() if self._meant(_first_key(p)) not in meant})
        return changed

    def merged(self, changes: Mapping[str, Any]) -> dict[str, Any]:
        """The constructor arguments with some values changed, as for `replace`."""
        arguments, either = self.arguments, self.either or ()
        for new in (key for key, value in changes.items() if value is not None):
            meant, given = self._meant(new), {self._meant(key) for key in arguments}
            if meant in either and meant not in given:
                meant = next(other for other in either if other != meant)
            arguments = {key: value for key, value in arguments.items() if self._meant(key) != meant}
        return arguments | dict(changes)

    def _meant(self, key: str) -> str:
        """The argument that another one is turned into."""
        return self.in_place_of.get(key, key)

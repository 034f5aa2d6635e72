"""Docstrings of the parts of a drive from their fields: meaning, unit, limits and default of each argument."""

import inspect
import textwrap
import types
import typing
from collections.abc import Mapping
from typing import Annotated, Any, Literal

from annotated_types import Ge, Gt, Le, Lt
from pydantic import BaseModel, BeforeValidator
from pydantic.fields import FieldInfo

_WIDTH = 100
_EXAMPLES = "\n\nExamples\n--------\n"
"""Stands last in a docstring."""
_NAMES = {float: "float", int: "int", bool: "bool", str: "str"}


def document(part: type[BaseModel], others: Mapping[str, FieldInfo]) -> str:
    """Docstring of a part with numpydoc sections of its constructor's arguments.

    Parameters
    ----------
    part
        A kind of part, whose docstring has no such section yet.
    others
        Arguments that are taken in place of fields, by their names.

    Returns
    -------
    str
        The docstring.
    """
    fields = {field.alias or name: field for name, field in part.model_fields.items()}
    told, heading, examples = inspect.cleandoc(part.__doc__ or "").partition(_EXAMPLES)
    return told + _section("Parameters", fields) + _section("Other Parameters", others) + heading + examples


def signature(part: type[BaseModel], others: Mapping[str, FieldInfo]) -> inspect.Signature:
    """Signature of the constructor of a part, for help and completion; arguments as for `document`.

    Returns
    -------
    inspect.Signature
        Keyword arguments only; those that another one may stand in for show None.
    """
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
    text = textwrap.fill(sentence, _WIDTH, initial_indent="    ", subsequent_indent="    ")
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


def _type(annotation: Any, metadata: typing.Sequence[Any] = ()) -> str:
    """A type in words: what may be given, without None."""
    origin, inner = typing.get_origin(annotation), typing.get_args(annotation)
    if isinstance(annotation, typing.TypeVar):
        return "float"
    if origin is Annotated:
        return _type(inner[0], inner[1:])
    if origin is Literal:
        return "{" + ", ".join(_literal(value) for value in inner) + "}"
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

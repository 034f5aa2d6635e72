"""Options of analyses: one schema for Python, commands and studies, from the annotations of their functions."""

import re
from collections.abc import Callable, Mapping, Sequence
from functools import cache, wraps
from inspect import Parameter, cleandoc, signature
from pathlib import Path
from types import NoneType, UnionType
from typing import Annotated, Any, ParamSpec, SupportsFloat, TypeVar, Union, get_args, get_origin

import numpy as np
from pydantic import BeforeValidator, Field, create_model

from beltdyn.errors import ModelError
from beltdyn.parts.messages import suggest
from beltdyn.parts.part import Part
from beltdyn.parts.quantity import Count, Ratio

ForceTolerance = Annotated[Ratio, Field(gt=0, lt=1)]
"""Tolerance of contact forces, relative, such as 0.01 or "1 %"."""
RangeCount = Annotated[Count, Field(ge=2, le=10_000)]
"""Numbers in a range."""

SHARED = ("output", "progress", "overwrite", "start", "integrator")
"""Parameters of analyses that are not options: whoever calls them fills them in."""

_WORDS = {
    str: "text",
    float: "a number",
    SupportsFloat: "a number",
    Sequence: "a list",
    np.ndarray: "a list",
    Path: "a file",
    bool: "true or false",
}
"""Types of options as users write them."""

P = ParamSpec("P")
R = TypeVar("R")


@cache
def options_of(function: Callable[..., Any]) -> dict[str, Parameter]:
    """The options of an analysis by name."""
    parameters = signature(function, eval_str=True).parameters.values()
    return {one.name: one for one in parameters if one.kind is Parameter.KEYWORD_ONLY and one.name not in SHARED}


def option_types(annotation: Any) -> tuple[Any, ...]:
    """The types of an option, without what describes them; numbers may be text with a unit, such as "1 %"."""
    if isinstance(annotation, UnionType) or get_origin(annotation) is Union:
        return tuple(dict.fromkeys(kind for one in get_args(annotation) for kind in option_types(one)))
    if get_origin(annotation) is Annotated:
        plain = get_args(annotation)[0]
        return (float, str) if plain is float else (plain,)
    return (annotation,)


def takes_options(function: Callable[P, R]) -> Callable[P, R]:
    """Let a function check its keyword arguments by type and range, and read numbers from text as drive files do.

    What is below the least number is zero in it, whatever NumPy is told to do then.
    """

    @wraps(function)
    def checked(*arguments: P.args, **options: P.kwargs) -> R:
        read: Any = options | read_options(function, options)
        with np.errstate(under="ignore"):
            return function(*arguments, **read)

    return checked


def read_options(function: Callable[..., Any], options: Mapping[str, Any]) -> dict[str, Any]:
    """The options among keyword arguments, checked.

    Parameters
    ----------
    function
        The analysis.
    options
        Name -> value, as in Python or in a study file.

    Raises
    ------
    ModelError
        If one has another type, or is out of range.
    """
    inner = getattr(function, "__wrapped__", function)
    known = options_of(inner)
    given = {name: _plain(value) for name, value in options.items() if name in known}
    for name, value in given.items():
        if value is None and known[name].default is not None and NoneType not in get_args(known[name].annotation):
            raise ModelError(f"{name} = None must have a value. Omit it for the default.")
        if isinstance(value, bytes):
            raise ModelError(f"{name} = {value!r} must not be bytes. Decode it.")
    try:
        read = _schema(inner)(**given)
    except ModelError as error:
        raise ModelError(re.sub(r"^options\.", "", str(error), flags=re.MULTILINE)) from None
    return {name: getattr(read, f"{name}_") for name in given}


def require_options(
    function: Callable[..., Any], given: Mapping[str, Any], name: str, leave_out: Sequence[str]
) -> None:
    """Make sure that options of a study are such, and complete."""
    known = {one: parameter for one, parameter in options_of(function).items() if one not in leave_out}
    for option in given:
        if option not in known:
            remedy = suggest(option, list(known)) if known else "It has no options"
            raise ModelError(f'options: {option} is not an option of "{name}". {remedy}.'.replace("?.", "?"))
    missing = [one for one, parameter in known.items() if parameter.default is parameter.empty and one not in given]
    if missing:
        raise ModelError(f'options: "{name}" needs {missing[0]}. Write it in [options].')


def _plain(value: Any) -> Any:
    return value.item() if isinstance(value, np.generic) else value


@cache
def _schema(function: Callable[..., Any]) -> type[Part]:
    """A part with the options of a function as fields."""
    described = _descriptions(function)
    fields: dict[str, Any] = {
        f"{name}_": (_read(one.annotation), Field(None, alias=name, description=described.get(name, "")))
        for name, one in options_of(function).items()
    }
    return create_model("Options", __base__=Part, **fields)


def _descriptions(function: Callable[..., Any]) -> dict[str, str]:
    """What docstrings say of parameters, as a clause."""
    text = cleandoc(function.__doc__ or "").partition("Parameters\n----------\n")[2].partition("\n\n")[0]
    found, name = dict[str, str](), ""
    for line in text.splitlines():
        if line[:1].strip():
            name = line.partition(":")[0].strip()
        else:
            found[name] = f"{found.get(name, '')} {line.strip()}".strip()
    first = {name: re.sub(r"^(A|An|The) ", "", said.partition(". ")[0].rstrip(".")) for name, said in found.items()}
    said = {name: f"{text[:1].lower()}{text[1:]}" for name, text in first.items()}
    return {name: text if text.startswith("how ") else f"the {text}" for name, text in said.items()}


def _read(annotation: Any) -> Any:
    """The field of an option: numbers and flags by their own schema, of anything else the type alone."""
    members = get_args(annotation) if isinstance(annotation, UnionType) or get_origin(annotation) is Union else ()
    others = [one for one in members or (annotation,) if one is not NoneType]
    if len(others) == 1 and (get_origin(others[0]) is Annotated or others[0] in (Any, Parameter.empty)):
        return others[0] | None if get_origin(others[0]) is Annotated else Any
    types = tuple(dict.fromkeys(get_origin(one) or one for one in others))
    return Annotated[Any, BeforeValidator(_of_types(types))]


def _of_types(types: tuple[type, ...]) -> Callable[[Any], Any]:
    """Checks that a value is of one of some types."""
    words = list(dict.fromkeys(_WORDS[one] for one in types if one in _WORDS))
    numbers: tuple[type, ...] = (int, float)
    accepted = tuple(kind for one in types for kind in (numbers if one in (float, SupportsFloat) else (one,)))

    takes_objects = any(one not in _WORDS for one in types)  # of another result the analysis says what is wrong

    def check(value: Any) -> Any:
        is_flag = isinstance(value, bool) and bool not in types
        is_object = takes_objects and type(value).__module__.startswith(f"{__package__.partition('.')[0]}.")
        if value is not None and (is_flag or not (is_object or isinstance(value, accepted))):
            raise ValueError(f"must be {' or '.join(words) or types[0].__name__}")
        return value

    return check

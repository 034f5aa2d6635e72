"""Analyses offered by the page, with the options of their functions."""

from functools import cache
from inspect import Parameter, signature
from pathlib import Path
from types import UnionType
from typing import Any, NamedTuple, get_args

from docstring_parser import parse

from beltdyn.analyses import ANALYSES
from beltdyn.errors import ModelError
from beltdyn.parts.error_location import shorten

_SHARED = ("output", "progress", "overwrite", "start", "checkpoint")
"""Options set by the page or not needed: its runs are not resumed."""
_SUFFIXES = {"table": (".csv",), "measured": (".csv",), "study": (".toml",), "compare": (".nc",)}
"""File option -> suffixes of its files; other file options offer all of these."""


class Option(NamedTuple):
    """An option of an analysis.

    Attributes
    ----------
    name : str
        As its function has it.
    kind : type
        str, int or float: what is given; Path of a file in the folder of the page.
    default : str
        What holds where it is left open; empty where it must be given, or is chosen.
    required : bool
        Whether it must be given.
    about : str
        What it means.
    takes_unit : bool
        Whether a number may have a unit.
    """

    name: str
    kind: type
    default: str
    required: bool
    about: str
    takes_unit: bool = False

    @property
    def suffixes(self) -> tuple[str, ...]:
        """Suffixes of the files of a file option; empty for others."""
        every = tuple(dict.fromkeys(one for suffixes in _SUFFIXES.values() for one in suffixes))
        return _SUFFIXES.get(self.name, every) if self.kind is Path else ()

    def read(self, text: str) -> str | int | float:
        """Parse typed text, or the name of a chosen file.

        Raises
        ------
        ModelError
            If it is no number, and should be one.
        """
        if self.kind in (str, Path):
            return text
        try:
            number: int | float = self.kind(text)
        except ValueError:
            if self.takes_unit:
                return text
            whole = "a whole number" if self.kind is int else "a number"
            raise ModelError(f"{self.name} = {shorten(text)} must be {whole}.") from None
        return number


@cache
def offered() -> dict[str, str]:
    """Analyses of a drive file with plain options and files, with their purposes."""
    return {
        name: one.purpose
        for name, one in ANALYSES.items()
        if all(_kind(each.annotation) or each.default is not Parameter.empty for each in _own(name))
    }


@cache
def options_of(name: str) -> tuple[Option, ...]:
    """Options of an analysis that are texts, numbers or files, required ones first."""
    found = []
    told = {one.arg_name: one.description or "" for one in parse(ANALYSES[name].function.__doc__ or "").params}
    for one in _own(name):
        if kind := _kind(one.annotation):
            required = one.default is Parameter.empty
            default = "" if required or one.default is None else str(one.default)
            about = " ".join(told[one.name].replace("`", "").split())
            found.append(Option(one.name, kind, default, required, about, _takes_unit(one.annotation)))
    return tuple(sorted(found, key=lambda option: not option.required))


def _own(name: str) -> list[Parameter]:
    parameters = signature(ANALYSES[name].function, eval_str=True).parameters.values()
    return [one for one in parameters if one.kind is Parameter.KEYWORD_ONLY and one.name not in _SHARED]


def _kind(annotation: Any) -> type | None:
    """What an option takes as it is typed or chosen; None where it is neither file, text nor number."""
    if _takes_unit(annotation):
        return float
    kinds = _kinds(annotation)
    return next((kind for kind in (Path, str, float, int) if kind in kinds), None)


def _takes_unit(annotation: Any) -> bool:
    """Whether an option is a number that may have a unit."""
    return {float, str} <= set(_kinds(annotation))


def _kinds(annotation: Any) -> tuple[Any, ...]:
    """The types of an option."""
    return get_args(annotation) if isinstance(annotation, UnionType) else (annotation,)

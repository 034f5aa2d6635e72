"""Validation errors as sentences: the key path, the value, the rule and the remedy."""

import difflib
import json
import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple

from pydantic import BaseModel, ValidationError
from pydantic_core import ErrorDetails

from beltdyn.parts.text_file import ErrorLocation, shorten

# Columns of numbers with equal decimals

_NOTHING = 1e-9
"""Magnitude below which a displayed number is rounding error, in any unit."""


def aligned(values: Sequence[float], digits: int = 4) -> list[str]:
    """Format a column with equal decimals, with the given digits for the largest number; – for a missing one."""
    largest = max((abs(value) for value in values if math.isfinite(value)), default=0.0)
    whole = math.floor(math.log10(largest)) + 1 if largest > _NOTHING else digits
    decimals = max(digits - whole, 0)
    return [f"{value:z.{decimals}f}" if math.isfinite(value) else "–" for value in values]


NOTABLE = 0.01
"""Relative distance beyond a limit from which a remedy is given: one that changes less changes nothing."""


def plain(value: float, digits: int = 4) -> str:
    """A number in so many digits without an exponent, such as 21970 for 21968.3."""
    return f"{float(f'{value:.{digits}g}'):.15g}"


def beyond(present: float, wanted: float, digits: int = 2) -> float:
    """A wanted value in so many digits, rounded away from the present one, so that a change to it is one."""
    if wanted == 0.0 or not math.isfinite(wanted):
        return wanted
    step = 10.0 ** (math.floor(math.log10(abs(wanted))) - digits + 1)
    rounded = math.ceil if wanted > present else math.floor
    steps = rounded(round(wanted / step, 2))  # 0.5 % of a step are rounding
    if wanted != present and math.isclose(step * steps, float(f"{present:.{max(digits, 2)}g}"), rel_tol=1e-9):
        steps += 1 if wanted > present else -1
    return float(f"{step * steps:.{digits}g}")


# A problem of a drive or its results: what is wrong, what it affects, what to do


@dataclass(frozen=True, slots=True)
class Finding:
    """A problem of a drive or its results, each part in whole sentences.

    Raises
    ------
    ValueError
        If a part is no sentence.

    Examples
    --------
    >>> found = bd.results.Finding("The belt is long.", "The slack span sags.", "Shorten it.")
    >>> print(found)
    The belt is long. The slack span sags. Shorten it.
    """

    fault: str
    """What is wrong, with its value and the rule that it breaks."""
    spoils: str
    """Which numbers it spoils, and by how much."""
    remedy: str
    """What to do."""
    kind: str = ""
    """Name of the check that found it, if one did."""
    weight: float = 0.0
    """The larger, the worse among findings of its kind: of many operating points the worst speaks for all."""

    def __post_init__(self) -> None:
        for part in (self.fault, self.spoils, self.remedy):
            if not part.endswith("."):
                raise ValueError(f"{part!r} must be a sentence, as part of a finding. End it with a full stop.")

    def __str__(self) -> str:
        return f"{self.fault} {self.spoils} {self.remedy}"


def listing(words: Sequence[str]) -> str:
    """Join words: "a", "a and b", "a, b and c"."""
    *others, last = words
    return f"{', '.join(others)} and {last}" if others else last


_LONGEST_VALUE = 60
"""Characters of a user's value in a message, at most; a longer one is shortened, so that its line stays readable."""
_LONGEST_SENTENCE = 1000
"""Characters of the explanation of an error, at most: it may quote several values."""
_MOST_ERRORS = 20
"""Errors that are explained, at most; of more the message gives the number."""
_RULES = {
    "greater_than": "must be greater than {gt:g}",
    "greater_than_equal": "must be at least {ge:g}",
    "less_than": "must be less than {lt:g}",
    "less_than_equal": "must be at most {le:g}",
    "finite_number": "must be a finite number",
    "float_type": "must be a number",
    "float_parsing": "must be a number",
    "int_type": "must be a whole number",
    "int_parsing_size": "is too large",
    "bool_type": "must be true or false, without quotation marks",
    "bool_parsing": "must be true or false, without quotation marks",
    "string_type": "must be text in quotation marks",
    "string_too_long": "is longer than {max_length} characters",
    "string_pattern_mismatch": "must consist of letters, digits, spaces, dots and dashes, the first a letter or digit",
    "tuple_type": "must be a list [...]",
    "too_short": "needs at least {min_length} entries",
    "too_long": "has more than {max_length} entries",
    "model_type": "must be a group of keys, such as {{ key = value }}",
}


class Told(NamedTuple):
    """An error message with its location."""

    location: tuple[int | str, ...]
    """Keys and positions in lists that lead to what is wrong, as in the user's data; empty for the whole."""
    sentence: str
    """Value, rule and remedy."""


def explain(error: ValidationError, model: type[BaseModel], data: Mapping[str, Any]) -> str:
    """Explain the validation errors of a drive or a part of it."""
    return "\n".join(dict.fromkeys(one.sentence for one in told_apart(error, model, data)))


def told_apart(error: ValidationError, model: type[BaseModel], data: Mapping[str, Any]) -> list[Told]:
    """Explain each error with its location; arguments as for `explain`."""
    locations = ErrorLocation(model, data)
    details = error.errors(include_url=False)[:_MOST_ERRORS]
    kept = [detail for detail in details if not _follows_from_another(detail, details, locations)]
    told = [
        Told(
            locations.in_data(detail["loc"]),
            _ended(shorten(_sentence(detail, locations).rstrip(". "), _LONGEST_SENTENCE)),
        )
        for detail in kept
    ]
    more = error.error_count() - len(details)
    return [*told, Told((), f"{more} more errors are not shown.")] if more > 0 else told


def _ended(sentence: str) -> str:
    return sentence if sentence.endswith("?") else f"{sentence}."


def _follows_from_another(detail: ErrorDetails, details: list[ErrorDetails], locations: ErrorLocation) -> bool:
    """Tell whether an error is only the shadow of another: of a misspelled key, or of a wrong entry in a list."""
    *parent, last = detail["loc"] or ("",)
    if detail["type"] == "missing":
        return any(
            other["type"] == "extra_forbidden"
            and other["loc"][:-1] == tuple(parent)
            and _nearest(str(other["loc"][-1]), locations.keys(tuple(parent))) == last
            for other in details
        )
    depth = len(detail["loc"])
    return detail["type"] == "too_short" and any(
        other["loc"][:depth] == detail["loc"] for other in details if len(other["loc"]) > depth
    )


def _sentence(detail: ErrorDetails, locations: ErrorLocation) -> str:
    kind, location, context = detail["type"], detail["loc"], detail.get("ctx", {})
    path, schema = locations.locate(location)
    value = show(detail["input"])
    if kind == "missing":
        return f"{path} is missing. {_remedy(schema)}".strip()
    if kind == "extra_forbidden":
        return f"{path} is not a known key. {suggest(str(location[-1]), locations.keys(location[:-1]))}"
    if kind == "value_error":
        return _own_sentence(path, value, str(context["error"]), detail["input"], schema)
    if kind in ("literal_error", "union_tag_invalid"):
        return _choice_sentence(path, detail)
    if kind in ("union_tag_not_found", "model_attributes_type"):
        kinds = ", ".join(locations.kinds(location))
        return f'{path} = {value} has no kind. Write {{ kind = "...", ... }} with one of the kinds {kinds}'
    rule = _RULES.get(kind)
    reason = rule.format(**context) if rule else detail["msg"]
    return f"{path} = {value} {reason}. {_remedy(schema)}".strip()


def _own_sentence(path: str, value: str, message: str, given: object, schema: dict[str, Any]) -> str:
    """Sentence for an error raised by our own validators: about a value, or about a group of keys."""
    if not isinstance(given, Mapping | BaseModel):
        return f"{path} = {value} {message}. {_remedy(schema)}".strip()
    joint = " " if message.startswith("has ") else ": "
    return f"{path}{joint}{message}" if path else message


def _choice_sentence(path: str, detail: ErrorDetails) -> str:
    given, context = detail["input"], detail["ctx"]
    expected = context.get("expected") or context["expected_tags"]
    choices = [choice.strip(" '\"") for choice in expected.replace(" or ", ",").split(",")]
    if detail["type"] == "union_tag_invalid":
        path, given = f"{path}.kind", context["tag"]
    return f"{path} = {show(given)} is not a valid choice. {suggest(str(given), choices)}"


def apart(first: float, second: float, digits: int = 5) -> tuple[str, str]:
    """Two numbers, with more digits if they would look equal otherwise."""
    for count in range(digits, 17):
        texts = f"{first:.{count}g}", f"{second:.{count}g}"
        if texts[0] != texts[1]:
            return texts
    return repr(first), repr(second)


_MAX_SUGGESTIONS = 3
"""Names that a message suggests, at most."""


def suggest(given: str, known: list[str]) -> str:
    """Suggest the nearest known name, or list all."""
    if not known:
        return "There are none to choose from"
    near = _nearest(given, known)
    names = [near] if near else _with_word(given, known)
    if names:
        quoted = [f'"{name}"' for name in names]
        return f"Did you mean {' or '.join(quoted)}?"
    return f"Choose one of {', '.join(known)}"


def _nearest(given: str, known: list[str]) -> str:
    near = difflib.get_close_matches(given.lower(), known, n=1, cutoff=0.6)
    return near[0] if near else ""


def _with_word(given: str, known: list[str]) -> list[str]:
    """The few names that have a word like a given one."""
    words = {word for name in known for word in name.split("_")}
    like = difflib.get_close_matches(given.lower(), words, n=1, cutoff=0.8)
    names = [name for name in known if like and like[0] in name.split("_")]
    return names if len(names) <= _MAX_SUGGESTIONS else []


def _remedy(schema: dict[str, Any]) -> str:
    description = schema.get("description", "")
    return (
        f"Give {description}" if description.startswith(("the ", "how ", "where ", "when ", "Poisson", "Young")) else ""
    )


def reason(error: Exception) -> str:
    """The reason why a file cannot be used, by the operating system, without a capital."""
    text = getattr(error, "strerror", None) or str(error)
    return text[:1].lower() + text[1:] if text[1:2].islower() else text


def show(value: object) -> str:
    """Format a value as in a drive file, shortened."""
    try:
        text = repr(value) if isinstance(value, float) else json.dumps(value, ensure_ascii=False)
    except (TypeError, ValueError, RecursionError):
        text = str(value)
    return shorten(text, _LONGEST_VALUE)

"""Reading and writing of TOML."""

import math
import pathlib
import re
import tomllib
from collections.abc import Mapping
from importlib.resources import files
from typing import Any, TypeVar

import tomli_w
from pydantic import ValidationError

from beltdyn.errors import ModelError
from beltdyn.model.drive import Drive
from beltdyn.model.pulley import refuse_functions
from beltdyn.parts.change import location_of, tolerances_of, unit_at, with_tolerances
from beltdyn.parts.messages import explain, reason
from beltdyn.parts.part import Part
from beltdyn.parts.quantity import written_like
from beltdyn.parts.text_file import LONGEST_TOML, open_file, parse_toml, read_text, shorten
from beltdyn.parts.toml_edits import Edit, changed_data, changed_text

Study = TypeVar("Study", bound=Part)

_LONGEST_REASON = 200
"""Characters of the parser's reason in a message, at most: it may quote keys of the file, which can be long."""
_SECTION = re.compile(r"(?:^|\n\n)(?=[A-Z]\w+\n---)")
"""Start of a section of a docstring."""


def _is_hdf5(path: pathlib.Path) -> bool:
    """Whether a file begins as those of results; one that cannot be read does not."""
    try:
        with open_file(path) as file:
            return file.read(4) == b"\x89HDF"
    except (OSError, ValueError):
        return False


def load(path: str | pathlib.Path) -> Drive:
    """Read a drive file.

    Parameters
    ----------
    path : str or pathlib.Path
        A TOML file.

    Returns
    -------
    Drive

    Raises
    ------
    ModelError
        If the file cannot be read, or does not describe a drive.

    Examples
    --------
    >>> with open("drive.toml", "w", encoding="utf-8") as file:
    ...     _ = file.write(bd.example("two_pulley").text)
    >>> bd.load("drive.toml").belt.elements
    20
    """
    path = pathlib.Path(path)
    return loads(_text_of(path, "drive", "A drive file is TOML; `beltdyn new` writes one."), base=path.parent)


def read_study(path: str | pathlib.Path, kind: type[Study]) -> Study:
    """Read a study file."""
    path = pathlib.Path(path)
    text = _text_of(path, "study", "A study file is TOML.")
    try:
        data = _parse(text, "the study file")
        return kind.model_validate(data)
    except ValidationError as error:
        lines = explain(error, kind, data).splitlines()
    except ModelError as error:
        lines = str(error).splitlines()
    raise ModelError("\n".join(f"{path}: {line}" for line in lines))


def _text_of(path: pathlib.Path, what: str, remedy: str) -> str:
    """The text of a file of a drive or a study."""
    try:
        return read_text(path, LONGEST_TOML)
    except (OSError, ValueError) as error:
        if _is_hdf5(path):
            message = f"{path} is a result file, not a {what} file. Give the TOML file of the {what}."
        elif isinstance(error, UnicodeDecodeError):
            message = f"{path} is not UTF-8 text. {remedy}"
        else:
            message = f"{path} cannot be read: {reason(error)}. Check the path."
        raise ModelError(message) from error


def loads(text: str, base: pathlib.Path | None = None) -> Drive:
    """Read a drive from the text of a drive file.

    Parameters
    ----------
    text : str
        TOML.
    base : pathlib.Path, optional
        The folder that relative paths in the text start from; by default the working directory.

    Returns
    -------
    Drive

    Raises
    ------
    ModelError
        If the text is not TOML, or does not describe a drive.

    Examples
    --------
    >>> drive = bd.loads(bd.example("two_pulley").text)
    >>> [pulley.name for pulley in drive.pulleys]
    ['driver', 'driven']
    """
    data = _parse(text, "the drive file")
    try:
        drive = Drive.model_validate(data, context={"base": base})
    except ValidationError as error:
        raise ModelError(explain(error, Drive, data)) from None
    if not _refers_to_files(data):
        drive._source = text
    return drive


def _parse(text: str, file: str) -> dict[str, Any]:
    try:
        return parse_toml(text)
    except tomllib.TOMLDecodeError as error:
        told = shorten(error, _LONGEST_REASON)
        raise ModelError(f"{file} is not valid TOML: {told}. Correct the file.") from error
    except ValueError as error:
        raise ModelError(f"{file} is not valid TOML: {error}.") from error


def _refers_to_files(data: Any) -> bool:
    """Tell whether a text is of no use without the files it names: CSV files, or the user's catalogue."""
    if isinstance(data, dict):
        return not {"file", "catalogue"}.isdisjoint(data) or any(_refers_to_files(value) for value in data.values())
    return isinstance(data, list) and any(_refers_to_files(value) for value in data)


def json_schema() -> dict[str, Any]:
    """The JSON schema of drive files, for checks and completion in editors.

    Returns
    -------
    dict

    Examples
    --------
    >>> bd.model.json_schema()["title"]
    'Drive'
    """
    schema = Drive.model_json_schema()
    for part in (schema, *schema["$defs"].values()):
        if "description" in part:  # its keys have their own, and sections on them are for those who write Python
            part["description"] = _SECTION.split(part["description"], maxsplit=1)[0]
    return {"$schema": "https://json-schema.org/draft/2020-12/schema", **_with_constants(schema)}


def _with_constants(schema: Any) -> Any:
    """Let a number, or text with a unit, stand wherever a constant profile may."""
    if isinstance(schema, list):
        return [_with_constants(one) for one in schema]
    if not isinstance(schema, dict):
        return schema
    inner = {key: _with_constants(value) for key, value in schema.items()}
    if "constant" not in inner.get("discriminator", {}).get("mapping", {}):
        return inner
    told = {key: inner.pop(key) for key in ("description", "default", "title") if key in inner}
    return {"anyOf": [{"type": "number"}, {"type": "string"}, inner], **told}


# Example drives that come with the package

_SUFFIX = ".toml"


def example(name: str) -> Drive:
    """Load an example drive.

    Parameters
    ----------
    name
        Such as "accessory_drive"; hyphens may replace underscores.

    Returns
    -------
    Drive
        Its ``text`` is the commented drive file.

    Raises
    ------
    ModelError
        If there is no such example; the message lists them all.

    Examples
    --------
    >>> [pulley.name for pulley in bd.example("washing_machine").pulleys]
    ['motor', 'drum']
    """
    return loads(example_text(name))


def example_text(name: str) -> str:
    """The drive file of an example."""
    found = example_texts()
    key = name.removesuffix(_SUFFIX).replace("-", "_")
    if key not in found:
        raise ModelError(f"example {name!r} does not exist. Choose one of {', '.join(found)}.")
    return found[key]


def example_texts() -> dict[str, str]:
    """Drive files of all examples by name, in alphabetical order."""
    drives = sorted(files("beltdyn").joinpath("examples").iterdir(), key=lambda file: file.name)
    return {
        file.name.removesuffix(_SUFFIX): file.read_text(encoding="utf-8")
        for file in drives
        if file.name.endswith(_SUFFIX)
    }


def dumps(drive: Drive) -> str:
    """Write a drive as TOML, in SI units, with all defaults and tolerances.

    Parameters
    ----------
    drive : Drive
        The drive; only given values are written. The drive of a run has its computed length or take-up.

    Returns
    -------
    str
        A text from which `loads` makes the same drive.

    Raises
    ------
    ModelError
        If a load is a function of Python.

    Examples
    --------
    >>> bd.loads(bd.dumps(drive)) == drive
    True
    """
    return spelled_out(drive, tolerances_of(drive))


def spelled_out(drive: Drive, tolerances: Mapping[str, float]) -> str:
    """Write a drive as `dumps` does, with given tolerances."""
    refuse_functions(drive.pulleys, "a drive file cannot hold a Python function", "keep the drive in a script")
    return tomli_w.dumps(with_tolerances(drive, drive.data, tolerances), multiline_strings=False)


# Change numbers in the text of a drive file and keep its comments, order and units

_SIGNIFICANT_DIGITS = 10
"""Significant digits of a changed number in a drive file, and of its comparison with the number intended: more than
data have, and few enough to hide rounding."""


def edited(drive: Drive, changes: Mapping[str, float]) -> str:
    """The text of a drive with some numbers changed, and the rest as its author wrote it.

    Examples
    --------
    >>> from beltdyn.model.toml import edited
    >>> text = edited(drive, {"belt.width": 0.012})
    >>> bd.loads(text).belt.width
    0.012
    """
    changed, data = drive.with_(changes), parse_toml(drive.text)
    try:
        edits = [_edit(data, path, value, unit_at(drive, path)) for path, value in changes.items()]
        text = changed_text(drive.text, edits, changed_data(data, edits))
        if text is not None and _near(loads(text).data, changed.data):
            return text
    except (LookupError, ValueError):
        pass
    return spelled_out(changed, tolerances_of(drive))


def _edit(data: dict[str, Any], path: str, value: float, unit: str) -> Edit:
    """The edit that gives a number its value in a drive file, where a default or a belt's profile may have given it."""
    *outer, last = location = location_of(data, path)
    holder: Any = data
    for key in outer:
        holder = holder[key]
    if isinstance(holder, str | int | float):  # a number that stands for a constant profile
        return Edit("set", tuple(outer), written_like(value, holder, unit, _SIGNIFICANT_DIGITS))
    given = holder.get(last) if isinstance(holder, dict) else holder[last]
    return Edit("set", location, written_like(value, given, unit, _SIGNIFICANT_DIGITS))


def _near(one: Any, other: Any) -> bool:
    """Whether data are the same, numbers to about ten digits."""
    if isinstance(one, dict) and isinstance(other, dict):
        return one.keys() == other.keys() and all(_near(one[key], other[key]) for key in one)
    if isinstance(one, list) and isinstance(other, list):
        return len(one) == len(other) and all(map(_near, one, other))
    if isinstance(one, float) and isinstance(other, float):
        return math.isclose(one, other, rel_tol=10.0 ** (1 - _SIGNIFICANT_DIGITS))
    return bool(one == other)

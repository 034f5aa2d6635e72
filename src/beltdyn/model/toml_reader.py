"""Drives from TOML."""

import pathlib
import tomllib
from typing import Any

from pydantic import ValidationError

from beltdyn.errors import ModelError
from beltdyn.model.drive import Drive
from beltdyn.parts.error_location import shorten
from beltdyn.parts.messages import explain, reason
from beltdyn.parts.text_file import LONGEST_TOML, parse_toml, read_text

_LONGEST_REASON = 200


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
    ...     _ = file.write(bd.published.demo_text())
    >>> bd.load("drive.toml").belt.elements
    20
    """
    path = pathlib.Path(path)
    try:
        text = read_text(path, LONGEST_TOML)
    except UnicodeDecodeError as error:
        raise ModelError(f"{path} is not a text in UTF-8. A drive file is TOML: `beltdyn new` writes one.") from error
    except (OSError, ValueError) as error:
        raise ModelError(f"{path} cannot be read: {reason(error)}. Check its name.") from error
    return loads(text, base=path.parent)


def loads(text: str, base: pathlib.Path | None = None) -> Drive:
    """Make a drive from the text of a drive file.

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
    >>> drive = bd.loads(bd.published.demo_text())
    >>> [pulley.name for pulley in drive.pulleys]
    ['driver', 'driven']
    """
    data = _parse(text)
    try:
        drive = Drive.model_validate(data, context={"base": base})
    except ValidationError as error:
        raise ModelError(explain(error, Drive, data)) from None
    if not _refers_to_files(data):
        drive._source = text
    return drive


def _parse(text: str) -> dict[str, Any]:
    try:
        return parse_toml(text)
    except tomllib.TOMLDecodeError as error:
        told = shorten(error, _LONGEST_REASON)
        raise ModelError(f"the drive file is not valid TOML: {told}. Correct the file there.") from error
    except ValueError as error:
        raise ModelError(f"the drive file is not valid TOML: {error}.") from error


def _refers_to_files(data: Any) -> bool:
    """Tell whether a text is of no use without the files it names: CSV files, or the user's catalogue."""
    if isinstance(data, dict):
        return not {"file", "catalogue"}.isdisjoint(data) or any(_refers_to_files(value) for value in data.values())
    return isinstance(data, list) and any(_refers_to_files(value) for value in data)


def json_schema() -> dict[str, Any]:
    """Make the JSON schema of drive files, with which editors check and complete them.

    Returns
    -------
    dict
    """
    return {"$schema": "https://json-schema.org/draft/2020-12/schema", **Drive.model_json_schema()}

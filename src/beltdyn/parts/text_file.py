"""Read text files and parse TOML, with size limits."""

import os
import re
import stat
import tomllib
from collections.abc import Mapping
from functools import cache
from pathlib import Path
from typing import Any, BinaryIO

from pydantic import BaseModel

# The location of an error as the path of the key in the user's data

_LONGEST_NAME = 60
"""Characters of a user's text in a message, at most, unless specified; a longer one is shortened to stay readable."""


def shorten(text: object, longest: int = _LONGEST_NAME) -> str:
    """Quote a user's value, shortened if it is long."""
    words = str(text)
    return words if len(words) <= longest else f"{words[: longest - 3]}..."


class ErrorLocation:
    """Follows an error through the JSON schema of a model and the user's data."""

    def __init__(self, model: type[BaseModel], data: Mapping[str, Any]) -> None:
        self._schema = _schema_of(model)
        self._data = data
        self._prefix = "" if getattr(model, "fills_a_file", False) else model.__name__.lower()

    def locate(self, location: tuple[int | str, ...]) -> tuple[str, dict[str, Any]]:
        """Find the path in the user's notation, ``pulley[driven].radius``, and the schema of its key."""
        path, _, schema = self._follow(location)
        return path, schema

    def in_data(self, location: tuple[int | str, ...]) -> tuple[int | str, ...]:
        """Find the keys and positions of the same place in the user's data, without kinds."""
        return self._follow(location)[1]

    def _follow(self, location: tuple[int | str, ...]) -> tuple[str, tuple[int | str, ...], dict[str, Any]]:
        """The path, the location in the data, and the schema."""
        path, data, steps = self._prefix, self._data, list[int | str]()
        schema = self._resolve(self._schema) | {"description": ""}
        for step in location:
            if isinstance(step, str) and step in schema.get("discriminator", {}).get("mapping", {}):
                schema = self._resolve({"$ref": schema["discriminator"]["mapping"][step]})
                continue
            if step in option_names(schema):
                schema = self._resolve(option_names(schema)[str(step)])
                continue
            steps.append(step)
            data, schema = _item(data, step), self._option(schema, step)
            if isinstance(step, int):
                path += f"[{entry_name(data) or step + 1}]"
                entries = schema.get("prefixItems") or [schema.get("items", {})]
                schema = {"description": schema.get("description", "")} | self._resolve(entries[0])
            else:
                path += f".{shorten(step)}" if path else shorten(step)
                schema = self._resolve(schema.get("properties", {}).get(step, {}))
        return path, tuple(steps), schema

    def keys(self, location: tuple[int | str, ...]) -> list[str]:
        """List the known keys at a location."""
        return list(self.locate(location)[1].get("properties", {}))

    def kinds(self, location: tuple[int | str, ...]) -> list[str]:
        """List the known kinds at a location."""
        return list(self.locate(location)[1].get("discriminator", {}).get("mapping", {}))

    def _option(self, schema: dict[str, Any], step: int | str) -> dict[str, Any]:
        """The first of several options that has entries for a position, or the key."""
        options = [self._resolve(option) for option in schema.get("anyOf", [])]
        for option in options:
            if ("items" in option) if isinstance(step, int) else (step in option.get("properties", {})):
                return {"description": schema.get("description", "")} | option
        return schema

    def _resolve(self, schema: dict[str, Any]) -> dict[str, Any]:
        """Replace a reference by what it refers to, and an optional value by the value."""
        if "$ref" in schema:
            return self._resolve(self._schema["$defs"][schema["$ref"].split("/")[-1]]) | schema
        given = [option for option in schema.get("anyOf", []) if option.get("type") != "null"]
        if len(given) == 1:
            return {"description": schema.get("description", "")} | self._resolve(given[0])
        return schema


def option_names(schema: Mapping[str, Any]) -> dict[str, dict[str, Any]]:
    """Names of alternative forms in locations: by their part, or their JSON type."""
    options = schema.get("oneOf", ()) if {"discriminator", "properties"}.isdisjoint(schema) else ()
    return {option.get("$ref", option.get("type", "")).split("/")[-1]: option for option in options}


def forget_schemas() -> None:
    """Make the schemas of models anew: kinds were registered."""
    _schema_of.cache_clear()


@cache
def _schema_of(model: type[BaseModel]) -> dict[str, Any]:
    """The JSON schema of a model, which takes longer to make than a drive to be read."""
    return model.model_json_schema(by_alias=True)


def _item(data: Any, step: int | str) -> Any:
    """The entries of a mapping, a list or a part."""
    if isinstance(data, BaseModel):
        return getattr(data, str(step), None)
    try:
        return data[step]
    except (TypeError, LookupError):
        return None


def entry_name(data: Any) -> str:
    """The label of a list entry: its name, or that of the pulley it carries; empty without one."""
    for key in ("name", "pulley"):
        name = _item(data, key)
        if isinstance(name, str):
            return shorten(name)
    return ""


LONGEST_TOML = 4_000_000
"""Bytes of the longest drive file or catalogue."""

LONGEST_TABLE = 100_000_000
"""Bytes of the longest CSV file."""

_NO_WAITING = getattr(os, "O_NONBLOCK", 0) | getattr(os, "O_BINARY", 0)
_MAX_NESTING = 32
"""Brackets around a value, or dots in a key, at most: more than a drive file needs. The memory of the parser grows with
the square of the number."""
_NO_STRUCTURE = re.compile(
    r'"""(?:\\.|[^\\])*?"""|' r"'''.*?'''|" r'"(?:\\.|[^"\\\n])*"|' r"'[^'\n]*'|" r"(?P<comment>\#[^\n]*)", re.DOTALL
)
_DOTTED = re.compile(r"[\w\-]+(?:[ \t]*\.[ \t]*[\w\-]+)*")
_BRACKET = re.compile(r"[\[\]{}]")


def as_text(name: str) -> str:
    """The name of a file as text, with a replacement character for undecodable bytes."""
    return name.encode(errors="surrogateescape").decode(errors="replace")


def read_text(path: Path, longest: int) -> str:
    """Read a UTF-8 text file."""
    return read_bytes(path, longest).decode("utf-8-sig").replace("\r\n", "\n")


def read_bytes(path: Path, longest: int) -> bytes:
    """Read a file up to a limit of size."""
    with open_file(path) as file:
        data, size = file.read(longest + 1), os.fstat(file.fileno()).st_size
    if len(data) > longest:
        raise ValueError(f"it has {max(size, len(data)):,} bytes; the limit is {longest:,}")
    return data


def open_file(path: Path) -> BinaryIO:
    """Open a regular file for reading; a pipe would block the reader."""
    if path.is_dir():  # which some systems do not open
        raise ValueError("is a directory")
    file = os.open(path, os.O_RDONLY | _NO_WAITING)
    if not stat.S_ISREG(os.fstat(file).st_mode):
        os.close(file)
        raise ValueError("it is a device or a pipe, not a file")
    return os.fdopen(file, "rb")


def parse_toml(text: str) -> dict[str, Any]:
    """Parse TOML."""
    if len(text) > LONGEST_TOML:
        raise ValueError(f"it is longer than {LONGEST_TOML:,} characters. Move long tables to CSV files")
    if _depth(text) > _MAX_NESTING:
        raise ValueError("it is nested too deeply")
    try:
        return tomllib.loads(text)
    except tomllib.TOMLDecodeError:
        raise
    except (ValueError, RecursionError) as error:
        raise ValueError("it is nested too deeply, or has a number with too many digits") from error


def _depth(text: str) -> int:
    """Largest number of brackets around a value, or of dots in a key; the parser needs its square in memory."""
    bare = _NO_STRUCTURE.sub(lambda found: "" if found["comment"] else "s", text)
    deepest = max((key.group().count(".") for key in _DOTTED.finditer(bare)), default=0)
    depth = 0
    for bracket in _BRACKET.finditer(bare):
        depth = depth + 1 if bracket.group() in "[{" else max(depth - 1, 0)
        deepest = max(deepest, depth)
    return deepest

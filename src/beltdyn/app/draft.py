"""The data of a drive file as a drive, or as errors with locations."""

from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any, NamedTuple

from pydantic import ValidationError

from beltdyn.errors import ModelError
from beltdyn.model import Drive
from beltdyn.parts.messages import Told, told_apart
from beltdyn.parts.toml_edits import Location

_FILES = ("file", "catalogue")
"""Keys with paths of input files."""


class Draft(NamedTuple):
    """A possibly invalid drive file."""

    data: Mapping[str, Any]
    """What it holds."""
    drive: Drive | None
    """The drive; none where something is wrong."""
    told: list[Told]
    """What is wrong, in the words of the command line."""

    def told_at(self, location: Location) -> list[str]:
        """Errors of a value, or of a group as a whole."""
        return [one.sentence for one in self.told if one.location == location]

    def told_below(self, location: Location) -> list[str]:
        """Errors of a value, or of anything inside it."""
        return [one.sentence for one in self.told if one.location[: len(location)] == location]


def draft(data: Mapping[str, Any], folder: Path, *, only_laid_out: bool = False) -> Draft:
    """Check a drive file."""
    outside = [
        Told(
            location,
            f"{'.'.join(map(str, location))} = {value!r} is outside {folder}, the only folder that this page reads. "
            "Copy the file there.",
        )
        for location, value in _paths((), data)
        if not (folder / value).resolve().is_relative_to(folder.resolve())
    ]
    if outside:
        return Draft(data, None, outside)
    try:
        context = {"base": folder, "only_laid_out": only_laid_out}
        return Draft(data, Drive.model_validate(data, context=context), [])
    except ValidationError as error:
        return Draft(data, None, told_apart(error, Drive, data))
    except ModelError as error:
        return Draft(data, None, [Told((), line) for line in str(error).splitlines()])


def _paths(location: Location, value: Any) -> Iterator[tuple[Location, str]]:
    """Places of paths of files, and the paths."""
    if isinstance(value, Mapping):
        for key, one in value.items():
            if key in _FILES and isinstance(one, str):
                yield (*location, key), one
            else:
                yield from _paths((*location, key), one)
    elif isinstance(value, list):
        for place, one in enumerate(value):
            yield from _paths((*location, place), one)

"""Tolerances of the numbers of a drive file, as in ``width = "12.5 ± 0.1 mm"``."""

from collections.abc import Iterator, Mapping
from typing import Any

from beltdyn.errors import ModelError
from beltdyn.machines.profiles.profile import Profile
from beltdyn.model.drive import Drive
from beltdyn.parts.change import as_argument, unit_at, value_at
from beltdyn.parts.error_location import entry_name
from beltdyn.parts.quantity import tolerance_in
from beltdyn.parts.text_file import parse_toml


def tolerances_of(drive: Drive) -> dict[str, float]:
    """Tolerances of the numbers of a drive, in SI units, by their paths.

    Parameters
    ----------
    drive : Drive
        The drive, as read from a file; one whose numbers were changed in Python has none.

    Returns
    -------
    dict of str to float
        Half the width of the interval in which a number lies; of a diameter that of the radius.

    Examples
    --------
    >>> from beltdyn.model.tolerances import tolerances_of
    >>> text = bd.example("two_pulley").text.replace('width = 0.01', 'width = "10 ± 0.2 mm"')
    >>> tolerances_of(bd.loads(text))
    {'belt.width': 0.0002}
    """
    found = dict[str, float]()
    for path, text in _texts(parse_toml(drive.text), ""):
        try:
            if isinstance(value_at(drive, path), Profile):
                path += ".value"
            tolerance = tolerance_in(text, unit_at(drive, path))
        except (ModelError, ValueError):
            continue  # no number: a name
        if tolerance is not None:
            number, size = as_argument(drive, path, tolerance)
            found[number] = size
    return found


def _texts(value: Any, path: str) -> Iterator[tuple[str, str]]:
    """All texts of a drive file, with the paths at which they stand."""
    if isinstance(value, str):
        yield path, value
    elif isinstance(value, Mapping):
        for key, inner in value.items():
            yield from _texts(inner, f"{path}.{key}" if path else key)
    elif isinstance(value, list):
        for number, inner in enumerate(value, 1):
            yield from _texts(inner, f"{path}[{entry_name(inner) or number}]")

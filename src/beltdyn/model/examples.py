"""Example drives that come with the package."""

from importlib.resources import files

from beltdyn.errors import ModelError
from beltdyn.model.drive import Drive
from beltdyn.model.toml_reader import loads

_SUFFIX = ".toml"


def example(name: str) -> Drive:
    """Load an example drive.

    Parameters
    ----------
    name
        Such as "accessory_drive"; a hyphen may stand for each underscore.

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

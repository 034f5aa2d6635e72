"""The only folder that the page reads and writes."""

import os
from pathlib import Path

from beltdyn.errors import ModelError
from beltdyn.parts.error_location import shorten
from beltdyn.parts.messages import reason
from beltdyn.parts.text_file import LONGEST_TOML, read_text
from beltdyn.results.atomic import atomic_path

_SUFFIX = ".toml"
_DEEPEST = 3
"""Largest depth of subfolders."""
_MOST_FILES = 200
_MOST_FOLDERS = 500


class Folder:
    """Drive files below a folder.

    Parameters
    ----------
    root : Path
        The folder.
    """

    def __init__(self, root: Path) -> None:
        self.root = root.resolve()

    def files(self, *suffixes: str) -> list[str]:
        """Names of files with one of these suffixes, by default of drive files, the nearest first.

        Hidden ones, and links to elsewhere, are left out.
        """
        suffixes = suffixes or (_SUFFIX,)
        found = list[str]()
        for looked, (place, folders, names) in enumerate(os.walk(self.root)):
            here = Path(place).relative_to(self.root)
            folders[:] = sorted(one for one in folders if not one.startswith((".", "_")))
            if len(here.parts) >= _DEEPEST or looked > _MOST_FOLDERS:
                folders.clear()
            found += [
                (here / name).as_posix()
                for name in sorted(names)
                if name.endswith(suffixes) and not name.startswith(".") and self._holds(here / name)
            ]
            if len(found) >= _MOST_FILES:
                break
        return sorted(found[:_MOST_FILES], key=lambda name: (name.count("/"), name))

    def path(self, name: str) -> Path:
        """The path of a file by its name.

        Parameters
        ----------
        name : str
            Relative to the folder; `.toml` is added where it is missing.

        Raises
        ------
        ModelError
            If it is none of a drive file in the folder.
        """
        name = name.strip()
        named = name if name.endswith(_SUFFIX) else f"{name}{_SUFFIX}"
        hidden = any(part.startswith(".") for part in Path(named).parts)
        if not name or len(name) > 200 or "\0" in name or hidden or not self._holds(Path(named)):
            raise ModelError(f'"{shorten(name)}" is not a file name in {self.root}. Give a name such as "drive.toml".')
        return (self.root / named).resolve()

    def read(self, name: str) -> str:
        """Read a drive file.

        Raises
        ------
        ModelError
            If it cannot be read.
        """
        path = self.path(name)
        try:
            return read_text(path, LONGEST_TOML)
        except UnicodeDecodeError as error:
            raise ModelError(f"{path} is not UTF-8 text. A drive file is TOML.") from error
        except (OSError, ValueError) as error:
            raise ModelError(f"{path} cannot be read: {reason(error)}. Check the path.") from error

    def write(self, name: str, text: str, known: str | None = None) -> Path:
        """Write a drive file.

        Parameters
        ----------
        name : str
            Its name.
        text : str
            What it shall hold.
        known : str, optional
            What the page knows that it holds; a file that is there and holds something else is kept.

        Returns
        -------
        Path
            The file.

        Raises
        ------
        ModelError
            If it cannot be written, or holds something else.
        """
        path = self.path(name)
        if path.exists() and (known is None or self.read(name) != known):
            changed = "already exists" if known is None else "was changed by another program"
            raise ModelError(f"{path} {changed} and would be overwritten. Save under another name.")
        if not path.parent.is_dir():
            raise ModelError(f"{path.parent} is not a folder. Create it, or save elsewhere.")
        with atomic_path(path, lambda _: True) as temporary:
            temporary.write_text(text, encoding="utf-8")
        return path

    def _holds(self, name: Path) -> bool:
        try:
            return (self.root / name).resolve().is_relative_to(self.root)
        except (OSError, ValueError, RuntimeError):
            return False

"""Run the Python blocks of docs/tasks and write their output below: `python docs/scripts/run_tasks.py [PAGE...]`."""

import contextlib
import io
import re
import sys
import tempfile
from collections.abc import Iterator
from importlib.resources import files
from pathlib import Path
from typing import Any

FOLDER = Path(__file__).parents[1] / "tasks"
_BLOCK = re.compile(r"```python\n(.*?)```\n\n```text\n(.*?)```", re.DOTALL)


def pages() -> list[Path]:
    """The pages with worked numbers."""
    return sorted(FOLDER.glob("*.md"))


def printed(page: Path) -> Iterator[tuple[str, str]]:
    """Run the blocks of a page one after another, in the working directory, which gets the drive files that they read.

    Yields
    ------
    said, found : str
        What stands below a block, and what it prints.
    """
    alternator = files("beltdyn").joinpath("examples", "alternator_drive.toml").read_text(encoding="utf-8")
    Path("alternator_drive.toml").write_text(alternator, encoding="utf-8")
    new = files("beltdyn.cli").joinpath("new_drive.toml").read_text(encoding="utf-8")
    Path("drive.toml").write_text(new, encoding="utf-8")
    names: dict[str, Any] = {}
    for code, said in _BLOCK.findall(page.read_text(encoding="utf-8")):
        with contextlib.redirect_stdout(io.StringIO()) as stream:
            exec(compile(code, page.name, "exec"), names)
        yield said, stream.getvalue()


def main() -> None:
    """Write what is printed into the pages, or into those whose names are arguments."""
    chosen = sys.argv[1:]
    for page in pages():
        if chosen and page.stem not in chosen:
            continue
        with tempfile.TemporaryDirectory() as folder, contextlib.chdir(folder):
            told = [found for _, found in printed(page)]
        text = page.read_text(encoding="utf-8")
        for block, found in zip(list(_BLOCK.finditer(text)), told, strict=True):
            text = text.replace(block[0], f"```python\n{block[1]}```\n\n```text\n{found}```")
        page.write_text(text, encoding="utf-8")


if __name__ == "__main__":
    main()

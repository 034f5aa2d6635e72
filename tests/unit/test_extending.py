"""The examples of docs/extending, applied to a copy of the source, work as they stand."""

import os
import re
import shutil
import subprocess
import sys
from pathlib import Path
from typing import NamedTuple

import pytest
from filelock import FileLock

ROOT = Path(__file__).parents[2]
INDEX = ROOT / "docs" / "extending.md"
PAGES = sorted((ROOT / "docs" / "extending").glob("*.md"))

COSTLY = {"surface", "friction_law", "normal_law", "stretch_law", "element", "analysis", "integrator"}
"""Pages whose examples compile kernels of their own, half a minute each; those of the others are the same."""

BLOCK = re.compile(r"^```\{code-block\} (\w+)\n:caption: ([^\n]+)\n\n(.*?)^```$", re.DOTALL | re.MULTILINE)
ROW = re.compile(r"^\| .*\(extending/(\w+)\.md\).* \| (\d+) \| (\d+) \|$", re.MULTILINE)


class Block(NamedTuple):
    """A block of a page: what it is in and under, and its text."""

    language: str
    caption: str
    text: str

    @property
    def is_check(self) -> bool:
        return self.caption == "check"

    @property
    def is_file(self) -> bool:
        return self.language != "diff" and not self.is_check

    @property
    def added(self) -> list[str]:
        """Lines that a diff adds."""
        return [line[1:] for line in self.text.splitlines() if line.startswith("+")] if self.language == "diff" else []


def blocks(page: Path) -> list[Block]:
    return [Block(*found) for found in BLOCK.findall(page.read_text(encoding="utf-8"))]


def apply(block: Block, tree: Path) -> None:
    """Write a new file, or add lines to one."""
    file = tree / block.caption
    if block.is_file:
        assert not file.exists(), f"{block.caption} is there already"
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text(block.text, encoding="utf-8")
        return
    known = "".join(line[1:] + "\n" for line in block.text.splitlines() if not line.startswith("+"))
    text = "\n" + file.read_text(encoding="utf-8")
    count = text.count("\n" + known)
    assert count == 1, f"{block.caption} holds {count} times, and not once, what the lines are added behind:\n{known}"
    end = text.index("\n" + known) + 1 + len(known)
    file.write_text(text[1:end] + "".join(line + "\n" for line in block.added) + text[end:], encoding="utf-8")


def contents(folder: Path) -> dict[Path, bytes]:
    """What the files below a folder hold."""
    files = (path for path in folder.rglob("*") if path.is_file() and "__pycache__" not in path.parts)
    return {path.relative_to(folder): path.read_bytes() for path in files}


@pytest.fixture(scope="module")
def extended(pytestconfig: pytest.Config, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Folder of the kernels, and of a copy of the source with the examples of all pages.

    It is the same for all processes and for later runs, so that kernels are compiled only where something has changed.
    """
    new, extended = tmp_path_factory.mktemp("new"), Path(pytestconfig.cache.mkdir("extended"))
    shutil.copytree(ROOT / "src", new / "src", ignore=shutil.ignore_patterns("__pycache__"))
    for page in PAGES:
        for block in blocks(page):
            if not block.is_check:
                apply(block, new)
                shutil.copystat(page, new / block.caption)
    with FileLock(extended / "lock"):
        if contents(new / "src") != contents(extended / "src"):
            shutil.rmtree(extended / "src", ignore_errors=True)
            shutil.copytree(new / "src", extended / "src")
    return extended


def test_every_page_is_listed_with_what_it_touches() -> None:
    listed = {name: (int(files), int(lines)) for name, files, lines in ROW.findall(INDEX.read_text(encoding="utf-8"))}
    touched = {
        page.stem: (sum(block.is_file for block in blocks(page)), sum(len(block.added) for block in blocks(page)))
        for page in PAGES
    }
    assert listed == touched


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.stem)
def test_every_page_has_a_check_that_asserts(page: Path) -> None:
    checks = [block.text for block in blocks(page) if block.is_check]
    assert len(checks) == 1
    assert "\nassert " in checks[0]


def test_the_code_of_the_pages_keeps_the_rules(extended: Path) -> None:
    written = sorted({block.caption for page in PAGES for block in blocks(page) if block.caption.endswith(".py")})
    for rules in (["check"], ["format", "--check"]):
        command = ["-m", "ruff", *rules, "--no-respect-gitignore", "--config", str(ROOT / "pyproject.toml"), *written]
        run(command, extended)


@pytest.mark.parametrize(
    "page",
    [pytest.param(page, marks=[pytest.mark.slow] if page.stem in COSTLY else []) for page in PAGES],
    ids=lambda page: page.stem,
)
def test_the_example_works(page: Path, extended: Path, tmp_path: Path) -> None:
    (check,) = (block.text for block in blocks(page) if block.is_check)
    (tmp_path / "check.py").write_text(check, encoding="utf-8")
    kernels = str(extended / "kernels")
    run(
        ["check.py"],
        tmp_path,
        PYTHONPATH=str(extended / "src"),
        BELTDYN_CACHE_DIR=kernels,
        MPLBACKEND="Agg",
        OMP_NUM_THREADS="1",
    )


def run(arguments: list[str], folder: Path, **surroundings: str) -> None:
    """Run Python in a folder, and make sure that it ends well."""
    command = [sys.executable, *arguments]
    done = subprocess.run(
        command, cwd=folder, env=os.environ | surroundings, capture_output=True, text=True, check=False
    )
    assert done.returncode == 0, done.stdout + done.stderr

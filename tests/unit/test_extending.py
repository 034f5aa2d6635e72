"""The examples of docs/extending, applied to a copy of the source, work as they stand."""

import os
import re
import shutil
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

import pytest
from filelock import FileLock

ROOT = Path(__file__).parents[2]
INDEX = ROOT / "docs" / "extending.md"
PAGES = sorted((ROOT / "docs" / "extending").glob("*.md"))

COSTLY = {
    "link",
    "load",
    "gas_spring",
    "surface",
    "friction_law",
    "normal_law",
    "stretch_law",
    "element",
    "analysis",
    "integrator",
    "result_variable",
    "figure",
}
"""Checks of examples that compile kernels of their own, half a minute each; those of the others are the same."""

OF_ALL_KINDS = [
    f"tests/{name}"
    for name in (
        "fuzz",
        *(f"unit/{family}" for family in ("contact", "elements", "machines", "parts", "stretch")),
        "unit/cli/test_commands.py",
        "unit/test_doctests.py",
        "unit/test_documents.py",
        "unit/test_examples.py",
        "unit/test_kinds.py",
        "unit/test_lazy.py",
        "unit/test_mirror.py",
        "unit/test_public_names.py",
        "unit/test_signatures.py",
        "unit/transient/test_earlier_results.py",
    )
]
"""Tests that ask something of every kind, analysis or figure."""

OF_THE_PACKAGE = "tests/unit/test_public_names.py::test_completion_shows_what_a_user_needs"
"""A test of how many names the package itself has, to which examples add theirs."""

TEST_OF_EXAMPLE = '''"""An example of docs/extending, whose check is its test."""

import runpy

import pytest


@pytest.mark.slow
def test_the_check_passes() -> None:
    runpy.run_path("docs/extending/code/{check}")
'''
"""What stands for the test of a module that an example adds; `test_the_example_works` runs the check."""

BLOCK = re.compile(
    r"^```\{(?:code-block\} diff|literalinclude\} (?P<file>[\w/.]+))\n"
    r":caption: (?P<caption>[^\n]+)\n(?P<text>.*?)^```$",
    re.DOTALL | re.MULTILINE,
)
CHECK = re.compile(r"\{download\}`check <(code/check_(\w+)\.py)>`")
ROW = re.compile(r"^\| \[.*?\]\(extending/(\w+\.md#[\w-]+)\) \| (\d+) \| (\d+) \|$", re.MULTILINE)


class Block(NamedTuple):
    """A new file with its path in the source, or lines that are added to the file of that path."""

    caption: str
    text: str
    source: Path
    is_file: bool

    @property
    def added(self) -> list[str]:
        """Lines that a diff adds."""
        return [] if self.is_file else [line[1:] for line in self.text.splitlines() if line.startswith("+")]


class Example(NamedTuple):
    """A section of a page: where it is, what it adds to the source, and its checks by their names."""

    place: str
    blocks: list[Block]
    checks: dict[str, Path]


def _block(page: Path, found: re.Match[str]) -> Block:
    caption = found["caption"].replace("\\", "")
    if found["file"]:
        file = page.parent / found["file"]
        return Block(caption, file.read_text(encoding="utf-8"), file, is_file=True)
    return Block(caption, found["text"].removeprefix("\n"), page, is_file=False)


def _examples(page: Path) -> Iterator[Example]:
    """Sections of a page with a check; the whole page where it has none below its title."""
    text = page.read_text(encoding="utf-8")
    for section in re.split(r"^## ", text, flags=re.MULTILINE)[1:] or [text.removeprefix("# ")]:
        anchor = section.splitlines()[0].lower().replace(" ", "-")
        yield Example(
            f"{page.name}#{anchor}",
            [_block(page, found) for found in BLOCK.finditer(section)],
            {name: page.parent / file for file, name in CHECK.findall(section)},
        )


EXAMPLES = [example for page in PAGES for example in _examples(page)]
CHECKS = {name: file for example in EXAMPLES for name, file in example.checks.items()}
BLOCKS = [block for example in EXAMPLES for block in example.blocks]


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
    for block in BLOCKS:
        apply(block, new)
        shutil.copystat(block.source, new / block.caption)
    with FileLock(extended / "lock"):
        if contents(new / "src") != contents(extended / "src"):
            shutil.rmtree(extended / "src", ignore_errors=True)
            shutil.copytree(new / "src", extended / "src")
    return extended


def test_every_example_is_listed_with_what_it_touches() -> None:
    listed = {place: (int(files), int(lines)) for place, files, lines in ROW.findall(INDEX.read_text(encoding="utf-8"))}
    touched = {
        example.place: (
            sum(block.is_file for block in example.blocks),
            sum(len(block.added) for block in example.blocks),
        )
        for example in EXAMPLES
    }
    assert listed == touched


@pytest.mark.parametrize("example", EXAMPLES, ids=lambda example: example.place)
def test_every_example_has_a_check_that_asserts(example: Example) -> None:
    (check,) = example.checks.values()
    assert "\nassert " in check.read_text(encoding="utf-8")


def test_every_file_of_code_is_on_a_page() -> None:
    files = {file.name for file in (ROOT / "docs" / "extending" / "code").glob("*.py")}
    shown = {Path(block.caption).name for block in BLOCKS if block.is_file}
    assert files == shown | {file.name for file in CHECKS.values()}


def test_the_code_of_the_pages_keeps_the_rules(extended: Path) -> None:
    written = sorted({block.caption for block in BLOCKS if block.caption.endswith(".py")})
    for rules in (["check"], ["format", "--check"]):
        command = ["-m", "ruff", *rules, "--no-respect-gitignore", "--config", str(ROOT / "pyproject.toml"), *written]
        run(command, extended)


@pytest.mark.parametrize(
    "name", [pytest.param(name, marks=[pytest.mark.slow] if name in COSTLY else []) for name in CHECKS]
)
def test_the_example_works(name: str, extended: Path, tmp_path: Path) -> None:
    kernels = str(extended / "kernels")
    run(
        [str(CHECKS[name])],
        tmp_path,
        PYTHONPATH=str(extended / "src"),
        BELTDYN_CACHE_DIR=kernels,
        MPLBACKEND="Agg",
        OMP_NUM_THREADS="1",
    )


@pytest.mark.slow
def test_the_house_asks_no_more_of_a_kind_than_its_page_says(extended: Path, tmp_path: Path) -> None:
    """Types, and the tests that run over all kinds, pass with the examples: a line elsewhere would not be counted."""
    house = tmp_path / "house"
    shutil.copytree(ROOT, house, ignore=shutil.ignore_patterns(".*", "__pycache__", "src", "_build", "beltdyn-*"))
    shutil.copytree(extended / "src", house / "src")
    surroundings = {"PYTHONPATH": f"{house / 'src'}{os.pathsep}{house}", "BELTDYN_CACHE_DIR": str(extended / "kernels")}
    run(["-m", "mypy"], house, **surroundings)
    run(["docs/scripts/key_tables.py"], house, **surroundings)
    add_tests(house / "tests" / "unit")
    run(
        ["-m", "pytest", "--quiet", "-m", "not slow", "--deselect", OF_THE_PACKAGE, *OF_ALL_KINDS],
        house,
        **surroundings,
    )


def add_tests(folder: Path) -> None:
    """Give every module of the examples its test."""
    for example in EXAMPLES:
        (check,) = example.checks.values()
        for module in (Path(block.caption).relative_to("src/beltdyn") for block in example.blocks if block.is_file):
            test = folder / module.parent / f"test_{module.stem}.py"
            test.parent.mkdir(exist_ok=True)
            test.write_text(TEST_OF_EXAMPLE.format(check=check.name), encoding="utf-8")


def run(arguments: list[str], folder: Path, **surroundings: str) -> None:
    """Run Python in a folder, and make sure that it ends well."""
    command = [sys.executable, *arguments]
    done = subprocess.run(
        command, cwd=folder, env=os.environ | surroundings, capture_output=True, text=True, check=False
    )
    assert done.returncode == 0, done.stdout + done.stderr

"""Mutation testing: change the sources in small ways, one at a time, and count the changes that a test notices.

    python tools/mutation.py contact results/derived --tests tests/unit

Kernels are run as plain Python, so that a change needs no compilation.  The tests run once to find which of them execute
which line, and how long they take.  Each mutant then meets the tests of its line, the quickest first, in a process of its
own, which starts from one that has imported the libraries already.  A mutant is killed if a test fails or takes too
long.  The answers are written to a JSON file; `--again` tries only those that survived there.
"""

import argparse
import ast
import copy
import json
import multiprocessing
import os
import random
import sys
import time
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from dataclasses import asdict, dataclass, field
from pathlib import Path

ROOT = Path(__file__).parents[1]
SOURCE = ROOT / "src" / "beltdyn"
LIBRARIES = [
    "coverage",
    "hypothesis",
    "matplotlib.pyplot",
    "numba",
    "numpy",
    "pydantic",
    "pytest",
    "rich",
    "scipy.optimize",
    "scipy.sparse.linalg",
    "scipy.integrate",
    "scipy.signal",
    "typer",
    "xarray",
]
SLOWEST = 4.0
"""Tests that take longer than this as plain Python are left out, s."""
PATIENCE = 60.0
"""A mutant that its tests do not finish in this time counts as killed, s."""

ARITHMETIC = {
    ast.Add: ast.Sub,
    ast.Sub: ast.Add,
    ast.Mult: ast.Div,
    ast.Div: ast.Mult,
    ast.FloorDiv: ast.Div,
    ast.Mod: ast.Mult,
    ast.Pow: ast.Mult,
}
BOUNDARY = {ast.Lt: ast.LtE, ast.LtE: ast.Lt, ast.Gt: ast.GtE, ast.GtE: ast.Gt}
OPPOSITE = {
    ast.Lt: ast.GtE,
    ast.LtE: ast.Gt,
    ast.Gt: ast.LtE,
    ast.GtE: ast.Lt,
    ast.Eq: ast.NotEq,
    ast.NotEq: ast.Eq,
    ast.Is: ast.IsNot,
    ast.IsNot: ast.Is,
    ast.In: ast.NotIn,
    ast.NotIn: ast.In,
}


@dataclass
class Mutant:
    """One change of one file.

    Attributes
    ----------
    file, line : str, int
        Where it is.
    before, after : str
        The expression or statement, as it was and as it is.
    number : int
        Its number among the changes of the file.
    outcome : str
        "killed", "survived" or "untested" (no test executes the line).
    """

    file: str
    line: int
    before: str
    after: str
    number: int
    outcome: str = ""


@dataclass
class Coverage:
    """Which tests execute a line, and how long a test takes."""

    tests: dict[str, dict[int, list[str]]] = field(default_factory=dict)
    duration: dict[str, float] = field(default_factory=dict)


def mutations(node: ast.AST) -> Iterator[ast.AST]:
    """Changed copies of a node."""
    if isinstance(node, ast.BinOp | ast.AugAssign) and type(node.op) in ARITHMETIC:
        yield _with(node, op=ARITHMETIC[type(node.op)]())
    elif isinstance(node, ast.Compare) and len(node.ops) == 1:
        for table in (BOUNDARY, OPPOSITE):
            if type(node.ops[0]) in table:
                yield _with(node, ops=[table[type(node.ops[0])]()])
    elif isinstance(node, ast.BoolOp):
        yield _with(node, op=ast.Or() if isinstance(node.op, ast.And) else ast.And())
    elif isinstance(node, ast.UnaryOp) and isinstance(node.op, ast.USub | ast.Not):
        yield node.operand
    elif isinstance(node, ast.If | ast.IfExp | ast.While) and not isinstance(node.test, ast.Compare):
        yield _with(node, test=ast.UnaryOp(ast.Not(), node.test))
    elif isinstance(node, ast.Constant) and isinstance(node.value, bool):
        yield ast.Constant(not node.value)
    elif isinstance(node, ast.Constant) and isinstance(node.value, int | float):
        yield ast.Constant(node.value + 1 if isinstance(node.value, int) else 2.0 * node.value or 1.0)
    elif isinstance(node, ast.Expr) and isinstance(node.value, ast.Call):
        yield ast.Pass()
    elif isinstance(node, ast.Continue):
        yield ast.Break()


def _with(node: ast.AST, **changes: object) -> ast.AST:
    changed = copy.copy(node)
    for name, value in changes.items():
        setattr(changed, name, value)
    return changed


def places(tree: ast.AST) -> Iterator[tuple[ast.AST, str, int | None]]:
    """Where expressions and statements stand: the parent, its field, and the index in it."""
    for parent in ast.walk(tree):
        for name, value in ast.iter_fields(parent):
            if name in ("decorator_list", "annotation", "returns", "bases") or isinstance(parent, ast.Raise):
                continue
            if isinstance(value, list):
                yield from ((parent, name, i) for i, item in enumerate(value) if isinstance(item, ast.AST))
            elif isinstance(value, ast.AST):
                yield parent, name, None


def skipped(tree: ast.AST) -> set[int]:
    """Nodes that are left alone: what is raised, annotations, decorators, records and texts."""
    left: set[int] = set()
    for node in ast.walk(tree):
        roots: list[ast.AST | None] = []
        if isinstance(node, ast.Raise | ast.JoinedStr | ast.Assert):
            roots = [node]
        elif isinstance(node, ast.AnnAssign):
            roots = [node.annotation]
        elif isinstance(node, ast.FunctionDef | ast.ClassDef):
            roots = [*node.decorator_list, getattr(node, "returns", None)]
        elif isinstance(node, ast.arg):
            roots = [node.annotation]
        for root in roots:
            left.update(id(child) for child in ast.walk(root)) if root is not None else None
    return left


def mutants_of(path: Path) -> Iterator[tuple[Mutant, ast.Module]]:
    """All changes of a file, with the changed trees; a tree holds until the next one is asked for."""
    tree = ast.parse(path.read_text(encoding="utf-8"))
    left, number = skipped(tree), 0
    for parent, name, index in list(places(tree)):
        value = getattr(parent, name)
        node = value if index is None else value[index]
        if id(node) in left or not hasattr(node, "lineno"):
            continue
        for change in mutations(node):
            ast.copy_location(change, node)
            ast.fix_missing_locations(change)
            if index is None:
                setattr(parent, name, change)
            else:
                value[index] = change
            yield Mutant(str(path.relative_to(ROOT)), node.lineno, _text(node), _text(change), number), tree
            number += 1
            if index is None:
                setattr(parent, name, node)
            else:
                value[index] = node


def _text(node: ast.AST) -> str:
    return ast.unparse(node).splitlines()[0][:100]


class _Contexts:
    """Tells the coverage tool which test runs, and keeps how long tests take."""

    def __init__(self, coverage: object) -> None:
        self.coverage, self.duration = coverage, {}

    def pytest_runtest_logstart(self, nodeid: str) -> None:
        self.coverage.switch_context(nodeid)

    def pytest_runtest_logreport(self, report: object) -> None:
        self.duration[report.nodeid] = self.duration.get(report.nodeid, 0.0) + report.duration


def cover(folders: list[str], tests: list[str], answer: str) -> None:
    """Run the tests once and write which of them execute which lines."""
    import coverage
    import pytest

    tool = coverage.Coverage(data_file=None, source=[str(SOURCE / folder) for folder in folders])
    contexts = _Contexts(tool)
    tool.start()
    pytest.main(
        [
            "-q",
            "-p",
            "no:cacheprovider",
            "-m",
            "not slow",
            "-o",
            "addopts=",
            "-W",
            "ignore::pytest.PytestAssertRewriteWarning",
            *tests,
        ],
        plugins=[contexts],
    )
    tool.stop()
    data = tool.get_data()
    lines = {
        str(Path(file).relative_to(ROOT)): {
            line: [test for test in who if test] for line, who in data.contexts_by_lineno(file).items()
        }
        for file in data.measured_files()
    }
    Path(answer).write_text(json.dumps({"tests": lines, "duration": contexts.duration}), encoding="utf-8")


def attempt(mutant: Mutant, tests: list[str], log: str) -> None:
    """Run tests with a mutant in place of its file; the process ends with pytest's code."""
    import importlib.abc
    import importlib.machinery

    path = ROOT / mutant.file
    tree = next(tree for other, tree in mutants_of(path) if other.number == mutant.number)
    code = compile(tree, str(path), "exec")

    class Loader(importlib.machinery.SourceFileLoader):
        def get_code(self, fullname: str) -> object:
            return code if Path(self.path) == path else super().get_code(fullname)

    hook = importlib.machinery.FileFinder.path_hook((Loader, [".py"]))

    class Finder(importlib.abc.MetaPathFinder):
        def find_spec(self, name: str, paths: object, target: object = None) -> object:
            if not name.startswith("beltdyn"):
                return None
            for folder in paths or [str(SOURCE.parent)]:
                spec = hook(folder).find_spec(name)
                if spec is not None:
                    return spec
            return None

    sys.meta_path.insert(0, Finder())
    with open(log, "w", encoding="utf-8") as out:
        os.dup2(out.fileno(), 1)
        os.dup2(out.fileno(), 2)
        import pytest

        os._exit(
            int(
                pytest.main(
                    [
                        "-x",
                        "-q",
                        "-p",
                        "no:cacheprovider",
                        "-o",
                        "addopts=",
                        "-W",
                        "ignore::pytest.PytestAssertRewriteWarning",
                        "--tb=line",
                        *tests,
                    ]
                )
            )
        )


def judge(mutant: Mutant, coverage: Coverage, context: object, budget: float) -> Mutant:
    """Find out what becomes of a mutant."""
    who = coverage.tests.get(mutant.file, {}).get(mutant.line, [])
    if not who:  # the line runs when its module is imported: any test of the module may notice
        of_file = coverage.tests.get(mutant.file, {}).values()
        who = (
            sorted({test for tests in of_file for test in tests})
            if mutant.line in coverage.tests.get(mutant.file, {})
            else []
        )
    known = sorted((coverage.duration.get(test, 0.0), test) for test in set(who))
    chosen, total = [], 0.0
    for duration, test in known:
        total += duration
        if duration > SLOWEST or total > budget:
            break
        chosen.append(test)
    if not chosen:
        mutant.outcome = "untested"
        return mutant
    process = context.Process(target=attempt, args=(mutant, chosen, os.devnull))
    process.start()
    process.join(PATIENCE)
    if process.is_alive():
        process.kill()
        process.join()
    mutant.outcome = "survived" if process.exitcode == 0 else "killed"
    return mutant


def main() -> None:
    """Read the command line, run, print the score of each folder."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folders", nargs="+", help="folders below src/beltdyn")
    parser.add_argument("--tests", nargs="+", default=["tests/unit"], help="tests that may kill")
    parser.add_argument("--sample", type=int, help="try that many mutants of each folder, taken at random")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--jobs", type=int, default=os.cpu_count())
    parser.add_argument("--budget", type=float, default=20.0, help="time that a mutant's tests may take unchanged, s")
    parser.add_argument("--out", type=Path, default=Path("mutation.json"))
    parser.add_argument("--again", type=Path, help="answers of a former run, of which the survivors are tried again")
    asked = parser.parse_args()
    os.environ.update(NUMBA_DISABLE_JIT="1", MPLBACKEND="Agg", PYTHONHASHSEED="0")
    os.environ["PYTHONPATH"] = str(ROOT / "src")
    os.chdir(ROOT)
    context = multiprocessing.get_context("forkserver")
    context.set_forkserver_preload(LIBRARIES)
    answer = str(asked.out.with_suffix(".coverage.json").absolute())
    process = context.Process(target=cover, args=(asked.folders, asked.tests, answer))
    process.start()
    process.join()
    read = json.loads(Path(answer).read_text(encoding="utf-8"))
    coverage = Coverage(
        {file: {int(line): who for line, who in lines.items()} for file, lines in read["tests"].items()},
        read["duration"],
    )
    chosen = list(_chosen(asked))
    print(f"{len(chosen)} mutants", flush=True)
    start = time.monotonic()
    done: list[Mutant] = []
    with ThreadPoolExecutor(asked.jobs) as pool:
        for mutant in pool.map(lambda mutant: judge(mutant, coverage, context, asked.budget), chosen):
            done.append(mutant)
            if mutant.outcome != "killed":
                print(
                    f"{mutant.outcome:8s} {mutant.file}:{mutant.line}  {mutant.before}  ->  {mutant.after}", flush=True
                )
            asked.out.write_text(json.dumps([asdict(each) for each in done], indent=1), encoding="utf-8")
    for folder in asked.folders:
        of_folder = [mutant for mutant in done if mutant.file.startswith(f"src/beltdyn/{folder}")]
        killed = sum(mutant.outcome == "killed" for mutant in of_folder)
        print(f"{folder}: {killed} of {len(of_folder)} killed, {100.0 * killed / max(len(of_folder), 1):.1f} %")
    print(f"{time.monotonic() - start:.0f} s")


def _chosen(asked: argparse.Namespace) -> Iterator[Mutant]:
    """The mutants to try."""
    former = json.loads(asked.again.read_text(encoding="utf-8")) if asked.again else None
    for folder in asked.folders:
        of_folder = [mutant for path in sorted((SOURCE / folder).rglob("*.py")) for mutant, _ in mutants_of(path)]
        if former is not None:
            survivors = {
                (each["file"], each["before"], each["after"], each["line"])
                for each in former
                if each["outcome"] != "killed"
            }
            of_folder = [m for m in of_folder if (m.file, m.before, m.after, m.line) in survivors]
        if asked.sample is not None and asked.sample < len(of_folder):
            of_folder = sorted(
                random.Random(asked.seed).sample(of_folder, asked.sample), key=lambda m: (m.file, m.number)
            )
        yield from of_folder


if __name__ == "__main__":
    main()

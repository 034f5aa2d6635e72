"""Tests mirror the sources: what a module does is tested in tests/unit/<package>/test_<module>.py."""

import ast
from pathlib import Path

import pytest

from beltdyn.analyses import ANALYSES

UNIT = Path(__file__).parent
SOURCE = UNIT.parents[1] / "src" / "beltdyn"

FAMILIES = {
    "elements/*.py": "unit/elements/test_kind.py",
    "stretch/*.py": "unit/stretch/test_laws_common.py",
    "show/plot/*.py": "unit/show/plot/test_figures_all.py",
}
"""Where a kind is tested with all of its family, if it has no test of its own."""

ELSEWHERE = {
    # Kinds of one contract: the test of their family runs over all of them alike.
    "contact/friction/*.py": "unit/contact/test_friction.py",
    "contact/normal/*.py": "unit/contact/test_normal.py",
    "contact/surface/*.py": "unit/contact/test_surface.py",
    "machines/links/*.py": "unit/machines/links/test_links.py",
    "machines/loads/*.py": "unit/machines/loads/test_shaft.py",
    "machines/profiles/*.py": "unit/machines/profiles/test_functions.py",
    "machines/carrying/*.py": "unit/machines/carrying/test_carrying.py",
    "machines/tensioners/__init__.py": "unit/machines/tensioners/test_tensioner.py",
    "elements/ancf/__init__.py": "unit/elements/ancf/test_element.py",
    "stretch/__init__.py": "unit/stretch/test_laws_common.py",
    "results/checks/*.py": "unit/results/test_checks.py",
    "show/plot/__init__.py": "unit/test_extend.py",
    # Parts of one calculation, which is tested as a whole: forces by their energies, tangents by differences.
    "system/observations.py": "unit/system/test_observe.py",
    "solvers/engine.py": "unit/solvers/test_alpha_advance.py",
    "show/line_sheet.py": "unit/designs/test_line_sheet.py",
    "designs/line_belt.py": "unit/designs/test_line_sheet.py",
    "designs/line_motions.py": "unit/designs/test_line_sheet.py",
    "designs/designs.py": "unit/designs/test_optimize.py",
    "designs/optimization_history.py": "unit/designs/test_optimize.py",
    "designs/study_table.py": "unit/designs/test_study.py",
    "designs/proposal.py": "unit/designs/test_selection.py",
    "designs/named_results.py": "unit/designs/test_sensitivity.py",
    # Seen by a user through something else, and tested there.
    "__init__.py": "unit/test_public_names.py",
    "analyses.py": "unit/cli/test_analysis.py",
    "cli/*.py": "unit/cli/test_commands.py",
    "cosimulation/beltdyn_fmi*.py": "unit/cosimulation/test_archive.py",
    "cosimulation/slave.py": "unit/cosimulation/test_archive.py",
    "results/__init__.py": "unit/test_public_names.py",
}
"""Where modules are tested that have no test of their name."""


def mirror(module: Path) -> list[Path]:
    """Tests of a module by their names, `test_MODULE` and `test_MODULE_SUBJECT`; of a package beside its folder."""
    inside = module.relative_to(SOURCE)
    folder, name = (
        (inside.parent.parent, inside.parent.name) if inside.name == "__init__.py" else (inside.parent, inside.stem)
    )
    return sorted((UNIT / folder).glob(f"test_{name}.py")) + sorted((UNIT / folder).glob(f"test_{name}_*.py"))


def has_functions(module: Path) -> bool:
    """Whether a module has a function that does something, other than to declare what others do."""
    nodes = ast.walk(ast.parse(module.read_text(encoding="utf-8")))
    functions = (node for node in nodes if isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef))
    return any(not _only_declares(function) for function in functions)


def _only_declares(function: ast.FunctionDef | ast.AsyncFunctionDef) -> bool:
    return all(isinstance(one, ast.Expr) and isinstance(one.value, ast.Constant) for one in function.body)


ANALYZED = {SOURCE.parent / f"{one.place.partition(':')[0].replace('.', '/')}.py" for one in ANALYSES.values()}
"""Modules of analyses, which `unit/transient/test_earlier_results.py` runs, interrupts and writes one like another."""


@pytest.fixture(scope="module")
def without() -> list[Path]:
    """Modules that no test is named after."""
    return [path for path in sorted(SOURCE.rglob("*.py")) if not mirror(path) and has_functions(path)]


def test_every_module_has_its_test_or_says_where_it_is_tested(without: list[Path]) -> None:
    listed = {path for pattern in ELSEWHERE | FAMILIES for path in SOURCE.glob(pattern)} | ANALYZED
    assert [path.relative_to(SOURCE).as_posix() for path in without if path not in listed] == []


def test_the_list_names_tests_that_there_are_for_modules_that_need_them(without: list[Path]) -> None:
    for pattern, test in ELSEWHERE.items():
        assert (UNIT.parent / test).is_file(), pattern
        assert set(SOURCE.glob(pattern)) & set(without), pattern

"""Tests mirror the sources: what a module does is tested in tests/unit/<package>/test_<module>.py."""

import ast
from pathlib import Path

import pytest

UNIT = Path(__file__).parent
SOURCE = UNIT.parents[1] / "src" / "beltdyn"

ELSEWHERE = {
    # Kinds of one contract: the test of their family runs over all of them alike.
    "errors.py": "unit/solve/observation/test_slip_through.py",
    "contact/friction/*.py": "unit/contact/test_friction.py",
    "contact/normal/*.py": "unit/contact/test_normal.py",
    "contact/surface/*.py": "unit/contact/test_surface.py",
    "elements/ancf/kind.py": "unit/elements/test_kind.py",
    "machines/links/*.py": "unit/machines/links/test_links.py",
    "machines/loads/*.py": "unit/machines/loads/test_shaft.py",
    "machines/profiles/*.py": "unit/machines/profiles/test_functions.py",
    "machines/tensioners/registry.py": "unit/machines/tensioners/test_tensioner.py",
    "stretch/*.py": "unit/stretch/test_laws.py",
    "results/checks/*.py": "unit/results/test_checks.py",
    # Parts of one calculation, which is tested as a whole: forces by their energies, tangents by differences.
    "elements/planar_curve.py": "unit/elements/test_kind.py",
    "elements/planar_curve_damping.py": "unit/elements/test_quintic.py",
    "elements/section.py": "unit/elements/test_kind.py",
    "system/body_forces.py": "unit/system/test_bodies.py",
    "system/dense_block.py": "unit/system/test_ring_matrix.py",
    "system/coupling.py": "unit/system/test_assembly.py",
    "system/flow_tangent.py": "unit/system/test_flowing_element.py",
    "system/element_state.py": "unit/system/test_discretization.py",
    "system/moving_center.py": "unit/system/test_bodies.py",
    "system/observations.py": "unit/system/test_observe.py",
    "system/pulley_state.py": "unit/system/test_balance.py",
    "system/state_forces.py": "unit/system/test_balance.py",
    "system/wrap_angle.py": "unit/system/test_spans.py",
    "solve/integrators/alpha_impulse.py": "verification/dynamics/test_impulse.py",
    "solve/integrators/alpha_method.py": "unit/solve/integrators/test_alpha_step.py",
    "solve/vibration/campbell_diagram.py": "unit/solve/test_campbell.py",
    "solve/vibration/mode_table.py": "unit/solve/test_modes.py",
    "solve/vibration/response_answers.py": "unit/solve/test_response.py",
    "solve/integrators/engine.py": "unit/solve/integrators/test_alpha_advance.py",
    "solve/integrators/integrator_state.py": "unit/solve/integrators/test_alpha_advance.py",
    "solve/observation/observer.py": "unit/solve/observation/test_recording.py",
    "solve/observation/result_layout.py": "unit/solve/observation/test_recording.py",
    "solve/studies/descent.py": "unit/solve/test_optimize.py",
    "solve/studies/designs.py": "unit/solve/test_optimize.py",
    "solve/studies/drive_numbers.py": "unit/solve/test_sensitivity.py",
    "solve/studies/found_drive.py": "unit/solve/test_optimize.py",
    "solve/studies/goals.py": "unit/solve/test_optimize.py",
    "solve/studies/measured_table.py": "unit/solve/test_calibrate.py",
    "solve/studies/named_results.py": "unit/solve/test_sensitivity.py",
    "solve/studies/optimization_history.py": "unit/solve/test_optimize.py",
    "solve/studies/residuals.py": "unit/solve/test_calibrate.py",
    "solve/studies/small_changes.py": "unit/solve/test_sensitivity.py",
    "solve/steady_running/newton.py": "unit/solve/test_steady.py",
    "solve/steady_running/point_values.py": "unit/solve/test_operating_map.py",
    "solve/steady_running/neighbour.py": "unit/solve/test_steady.py",
    "solve/steady_running/refinement.py": "unit/solve/test_steady.py",
    "solve/steady_running/search.py": "unit/solve/test_steady.py",
    "solve/studies/point_work.py": "unit/solve/test_study.py",
    "solve/studies/study_rows.py": "unit/solve/test_study.py",
    "solve/studies/study_table.py": "unit/solve/test_study.py",
    "solve/spawning.py": "unit/solve/test_batch.py",
    "solve/worker.py": "unit/solve/test_batch.py",
    "model/parameter_study.py": "unit/solve/studies/test_study_plan.py",
    "plot/study_effects.py": "unit/plot/test_study.py",
    "plot/study_values.py": "unit/plot/test_study.py",
    "results/study_sheet.py": "unit/cli/test_study.py",
    # Seen by a user through something else, and tested there.
    "app/analysis_view.py": "unit/app/test_page.py",
    "app/calculator.py": "unit/app/test_computing.py",
    "app/canvas.py": "unit/app/test_page.py",
    "app/file_menu.py": "unit/app/test_page.py",
    "app/form_view.py": "unit/app/test_page.py",
    "app/numbers_view.py": "unit/app/test_page.py",
    "app/sheet_view.py": "unit/app/test_page.py",
    "app/workspace.py": "unit/app/test_session.py",
    "__init__.py": "unit/test_public_names.py",
    "analyses.py": "unit/cli/test_analysis.py",
    "cli/*.py": "unit/cli/test_commands.py",
    "cosimulation/beltdyn_fmi*.py": "unit/cosimulation/test_fmu.py",
    "cosimulation/description.py": "unit/cosimulation/test_fmu.py",
    "cosimulation/slave.py": "unit/cosimulation/test_fmu.py",
    "model/advice.py": "unit/model/test_drive.py",
    "model/open_path.py": "unit/model/test_end.py",
    "model/picture.py": "unit/results/test_notebook_drive.py",
    "results/__init__.py": "unit/test_public_names.py",
    "results/static.py": "unit/solve/test_equilibrium.py",
    "results/rest_sheet.py": "unit/cli/test_commands.py",
    "results/run_sheet.py": "unit/cli/test_screen.py",
    "results/means.py": "unit/results/test_summary.py",
}
"""Where modules are tested that have no test of their name."""


def mirror(module: Path) -> Path:
    """The test of a module by its name; that of a package is beside its folder."""
    inside = module.relative_to(SOURCE)
    if inside.name == "__init__.py":
        return UNIT / inside.parent.parent / f"test_{inside.parent.name}.py"
    return UNIT / inside.parent / f"test_{inside.stem}.py"


def has_functions(module: Path) -> bool:
    """Whether a module has a function that does something, other than to declare what others do."""
    nodes = ast.walk(ast.parse(module.read_text(encoding="utf-8")))
    functions = (node for node in nodes if isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef))
    return any(not _only_declares(function) for function in functions)


def _only_declares(function: ast.FunctionDef | ast.AsyncFunctionDef) -> bool:
    return all(isinstance(one, ast.Expr) and isinstance(one.value, ast.Constant) for one in function.body)


WITHOUT = [path for path in sorted(SOURCE.rglob("*.py")) if has_functions(path) and not mirror(path).exists()]
"""Modules that no test is named after."""


def test_every_module_has_its_test_or_says_where_it_is_tested() -> None:
    listed = {path for pattern in ELSEWHERE for path in SOURCE.glob(pattern)}
    assert [path.relative_to(SOURCE).as_posix() for path in WITHOUT if path not in listed] == []


@pytest.mark.parametrize("pattern", ELSEWHERE)
def test_the_list_names_tests_that_there_are_for_modules_that_need_them(pattern: str) -> None:
    assert (UNIT.parent / ELSEWHERE[pattern]).is_file()
    assert set(SOURCE.glob(pattern)) & set(WITHOUT)

"""Calibrations find the numbers with which measurements were made."""

from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from scipy import stats

from beltdyn.arrays import FloatArray
from beltdyn.designs.calibrate import _warnings, calibrate, fit
from beltdyn.designs.designs import Free
from beltdyn.designs.found_state import Resting
from beltdyn.errors import ModelError
from beltdyn.model import CalibrationStudy, Drive, example, loads, prepare
from beltdyn.results import Result, open_result, summarize
from beltdyn.solvers.run_progress import Progress
from beltdyn.state.equilibrium import equilibrium
from beltdyn.state.staying import bring_to_stand
from beltdyn.state.steady import steady_state
from validation.published.cases import better, loaded_two_pulley

TRUE_MODULUS = 1.08e9
TORQUES = np.array([-15.0, -30.0, -45.0, -60.0, -75.0])
TENSIONS = np.array([300.0, 450.0, 600.0])
DEVIATION = 0.005
"""Of slips, relative."""
MODULUS: dict[str, Any] = {"path": "belt.youngs_modulus", "least": "800 MPa", "largest": "1500 MPa"}
SLIPS: dict[str, Any] = {"table": "slip.csv"}
SPAN = "driver-driven"


@pytest.fixture(scope="module")
def drive() -> Drive:
    given = better(loaded_two_pulley(creep_rate_factor=1e6))
    return given.replace(belt=given.belt.replace(length=None, installed_tension=600.0))


@pytest.fixture(scope="module")
def slips(drive: Drive) -> FloatArray:
    """Slip over torque of the drive with the true stiffness."""
    true = drive.with_({"belt.youngs_modulus": TRUE_MODULUS})
    runs = [steady_state(true.with_({"pulley[driven].torque.value": torque})) for torque in TORQUES]
    return np.array([summarize(run).pulleys[1].slip for run in runs])


def write(folder: Path, values: FloatArray, deviations: FloatArray | None = None) -> None:
    more = "" if deviations is None else ", ± pulley_slip[driven] [%]"
    lines = [f"driven torque [N m], pulley_slip[driven] [%]{more}"]
    for number, (torque, value) in enumerate(zip(TORQUES, values, strict=True)):
        last = "" if deviations is None else f", {float(100.0 * deviations[number])}"
        lines.append(f"{torque}, {float(100.0 * value)}{last}")
    (folder / "slip.csv").write_text("\n".join(lines), encoding="utf-8")


def study_file(folder: Path) -> Path:
    file = folder / "study.toml"
    text = '[[number]]\npath = "belt.youngs_modulus"\nleast = "800 MPa"\nlargest = "1500 MPa"\n'
    file.write_text(f'{text}[[measurement]]\ntable = "slip.csv"\n', encoding="utf-8")
    return file


@pytest.mark.slow
def test_stiffness_from_slip(drive: Drive, slips: FloatArray, tmp_path: Path) -> None:
    """Without noise it is that of the measurements, within what two meshes differ."""
    write(tmp_path, slips)
    found = calibrate(drive, study=study_file(tmp_path), output=tmp_path / "out.nc")
    assert float(found.dataset.fitted[0]) == pytest.approx(TRUE_MODULUS, rel=2e-4)
    assert float(found.dataset.residual_deviation) < 1e-4
    assert loads((tmp_path / "out.toml").read_text(encoding="utf-8")) == open_result(tmp_path / "out.nc").drive
    assert found.drive.belt.youngs_modulus == pytest.approx(TRUE_MODULUS, rel=2e-4)


def test_what_cannot_be_computed_is_refused(drive: Drive, tmp_path: Path) -> None:
    """Before anything is fitted: without power there is no efficiency."""
    rows = ["driven torque [N m], efficiency", "-30, 0.98", "0, 0.5"]
    (tmp_path / "slip.csv").write_text("\n".join(rows), encoding="utf-8")
    said = r"efficiency \(slip, row 2\) was measured, but cannot be computed"
    with pytest.raises(ModelError, match=said):
        calibrate(drive, study=study_file(tmp_path))


def test_an_interrupted_calibration_keeps_what_it_has_come_to(drive: Drive, slips: FloatArray, tmp_path: Path) -> None:
    """Its file says so, and the drive file beside it holds the numbers; they are there before, if it is killed."""
    write(tmp_path, slips)
    before = list[Result]()

    def interrupt(progress: Progress) -> None:
        assert (progress.duration, progress.phase) == (60.0, "designs")  # so many at most
        if progress.time >= 3.0:
            before.append(open_result(tmp_path / "out.nc"))
            raise KeyboardInterrupt

    found = calibrate(drive, study=study_file(tmp_path), output=tmp_path / "out.nc", progress=interrupt)
    kept = open_result(tmp_path / "out.nc")
    assert found.status == kept.status == "interrupted"
    ends = np.array([found.dataset.lower, found.dataset.upper]) - found.dataset.fitted.values
    reach = stats.t.ppf(0.975, len(TORQUES) - 1)
    np.testing.assert_allclose(ends / found.dataset.standard_error.values, [[-reach], [reach]], rtol=1e-6)
    assert before[0].dataset.fitted[0] == kept.dataset.fitted[0]
    assert any("the search was interrupted" in warning for warning in kept.warnings)
    assert abs(kept.dataset.fitted[0] / TRUE_MODULUS - 1.0) < abs(kept.dataset.start[0] / TRUE_MODULUS - 1.0)
    assert loads((tmp_path / "out.toml").read_text(encoding="utf-8")) == kept.drive


@pytest.mark.slow
def test_noise_gives_intervals_of_its_size(drive: Drive, slips: FloatArray, tmp_path: Path) -> None:
    """Slip goes with 1/E: five measurements of a deviation tell E to that deviation over sqrt(5)."""
    noise = 1.0 + DEVIATION * np.random.default_rng(3).standard_normal(slips.size)
    write(tmp_path, slips * noise, DEVIATION * slips)
    found = calibrate(drive, study=study_file(tmp_path)).dataset
    relative = float(found.standard_error[0] / found.fitted[0])
    assert relative == pytest.approx(DEVIATION / np.sqrt(slips.size), rel=0.1)
    assert float(found.lower[0]) < TRUE_MODULUS < float(found.upper[0])


@pytest.mark.slow
def test_stiffness_from_frequencies_at_rest(drive: Drive, tmp_path: Path) -> None:
    """Rows are other drives: of a belt of given length, tension and frequencies go with its stiffness."""
    true = drive.replace(belt=drive.belt.replace(installed_tension=None, length=1.2443))
    lengths = np.array([1.2443, 1.2403])
    lines = [f"belt.length [mm], frequency[{SPAN}] [Hz]"]
    for length in lengths:
        state = Resting(
            bring_to_stand(prepare(true.with_({"belt.length": length, "belt.youngs_modulus": TRUE_MODULUS})))
        )
        lines.append(f"{float(1e3 * length)}, {state.value(f'frequency[{SPAN}]')}")
    (tmp_path / "slip.csv").write_text("\n".join(lines), encoding="utf-8")
    file = study_file(tmp_path)
    file.write_text(f"{file.read_text(encoding='utf-8')}state = 'rest'\n", encoding="utf-8")
    found = calibrate(true, study=file).dataset
    assert float(found.fitted[0]) == pytest.approx(TRUE_MODULUS, rel=1e-3)
    assert found.row.values.tolist() == ["slip, row 1", "slip, row 2"]


@pytest.mark.slow
def test_what_measurements_do_not_tell(drive: Drive, slips: FloatArray, tmp_path: Path, monkeypatch: Any) -> None:
    """Young's modulus and the axial factor do the same to a belt without bending stiffness worth the name."""
    write(tmp_path, slips)
    monkeypatch.chdir(tmp_path)
    factor = {"path": "belt.poissons_ratio", "least": 0.25, "largest": 0.35}
    found = calibrate(drive, study=CalibrationStudy(number=[MODULUS, factor], measurement=[SLIPS]))
    errors = found.dataset.standard_error.values
    assert not np.all(np.isfinite(errors)) or errors[1] > 0.1
    assert np.all(found.dataset.upper > found.dataset.lower)


@pytest.mark.parametrize(
    ("columns", "said"),
    [
        ([[1.0, 2.0, 3.0], [0.0, 0.0, 0.0]], "cannot identify b: no measured result depends on it"),
        ([[1.0, 2.0, 3.0], [2.0, 4.0, 6.0]], "cannot identify a, b separately: they affect the same results"),
        ([[100.0, 200.0, 300.0], [100.0, 200.0, 301.0]], "errors of a and b are correlated by -1.000"),
        ([[100.0, 0.0, 0.0], [0.0, 0.1, 0.0]], "b: the confidence interval is wider than the bounds"),
    ],
)
def test_numbers_that_are_not_told_are_named(columns: list[list[float]], said: str) -> None:
    """Straight residuals of two numbers, of deviation 1."""
    jacobian = np.array(columns).T
    numbers = [Free(path, "", 0.0, 1.0, 0.5) for path in ("a", "b")]
    middle = np.array([0.5, 0.5])
    found = fit(lambda x: jacobian @ (x - middle), lambda x: jacobian, middle, 0.95, known=True)
    fitting: Any = SimpleNamespace(series=[], known=True)
    assert any(said in warning for warning in _warnings(numbers, fitting, found))


@pytest.mark.slow
def test_intervals_hold_the_true_numbers_as_often_as_they_say(drive: Drive, slips: FloatArray, tmp_path: Path) -> None:
    """Of 20 calibrations with noise, intervals of 90 % hold the true stiffness in 18, within 3 deviations of 1.3."""
    rng, held, count = np.random.default_rng(11), 0, 20
    for _ in range(count):
        write(tmp_path, slips * (1.0 + DEVIATION * rng.standard_normal(slips.size)), DEVIATION * slips)
        file = study_file(tmp_path)
        file.write_text(f"confidence = 0.9\n{file.read_text(encoding='utf-8')}", encoding="utf-8")
        found = calibrate(drive, study=file).dataset
        held += bool(found.lower[0] <= TRUE_MODULUS <= found.upper[0])
    assert abs(held - 0.9 * count) <= 3.0 * np.sqrt(0.09 * count)


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("driven torque [N m]\n-3\n", "has no column of results"),
        ("pulley_slip[driven], wind\n1, 2\n", 'the heading "wind" is not a result'),
        ("pulley_slip[driven]\nmuch\n", 'line 2: "much"'),
        ("hub_load[driven] [m]\n3\n", "must be in units of N"),
        ("idler torque [N m], pulley_slip[driven]\n3, 1\n", "pulley = 'idler' is not in this drive"),
        ("hub_load[driven], ± pulley_slip[driven]\n3, 1\n", 'needs a column "pulley_slip'),
        (
            "hub_load[driven], pulley_slip[driven], ± pulley_slip[driven]\n3, 1, 1\n",
            "has no standard deviation of hub_load",
        ),
        ("belt.youngs_modulus [MPa], pulley_slip[driven]\n1000, 0.1\n", "which is to be fitted"),
        ("pulley_slip[driven]\n\n", "has no rows"),
        ("pulley_slip[driven], load\n,1\n", "pulley_slip[driven] was not measured in any row"),
        ("load, pulley_slip[driven]\n1\n", "line 2: 1 cells but 2 headings"),
    ],
)
def test_wrong_tables_are_told(drive: Drive, tmp_path: Path, text: str, said: str) -> None:
    (tmp_path / "slip.csv").write_text(text, encoding="utf-8")
    with pytest.raises(ModelError) as error:
        calibrate(drive, study=study_file(tmp_path))
    assert said in str(error.value)


@pytest.mark.slow
def test_a_result_is_shown(drive: Drive, slips: FloatArray, tmp_path: Path) -> None:
    write(tmp_path, slips)
    found: Result = calibrate(drive, study=study_file(tmp_path))
    assert found.kind == "calibrate"
    assert "calibrated with 5 measured values, intervals of 95%" in str(found.dataset.attrs["title"])


def test_tension_and_length_at_rest_are_fitted(tmp_path: Path, drive: Drive) -> None:
    """The stiffness with which a belt of a length has a tension."""
    given = drive.replace(belt=drive.belt.replace(length=None, installed_tension=600.0))
    rest = equilibrium(given.with_({"belt.youngs_modulus": TRUE_MODULUS}))
    length, tension = (float(rest.dataset[name]) for name in ("belt_length", "tension"))
    (tmp_path / "rest.csv").write_text(f"tension [N], belt_length [m]\n{tension}, {length!r}\n", encoding="utf-8")
    table = str(tmp_path / "rest.csv")
    study = CalibrationStudy(number=[MODULUS], measurement=[{"table": table, "state": "rest"}])
    found = calibrate(given, study=study)
    assert float(found.dataset["fitted"][0]) == pytest.approx(TRUE_MODULUS, rel=1e-3)
    with pytest.raises(ModelError, match='"tension" is not a result'):
        calibrate(given, study=CalibrationStudy(number=[MODULUS], measurement=[{"table": table}]))


def test_an_open_belt_is_calibrated_at_rest(tmp_path: Path) -> None:
    """The weight of a band brake whose hub load was measured, as `equilibrium` finds it."""
    drive = example("band_brake")
    rest = equilibrium(drive.with_({"end[weight].mass": 12.0}))
    load = float(np.linalg.norm(rest.dataset["hub_force"].values))
    (tmp_path / "rest.csv").write_text(f"hub_load[drum] [N]\n{load!r}\n", encoding="utf-8")
    mass = {"path": "end[weight].mass", "least": "5 kg", "largest": "20 kg"}
    study = CalibrationStudy(number=[mass], measurement=[{"table": str(tmp_path / "rest.csv"), "state": "rest"}])
    found = calibrate(drive, study=study)
    assert float(found.dataset["fitted"][0]) == pytest.approx(12.0, rel=1e-6)

"""Calibrate the belt rig of docs/verification/design.md, and draw how often its intervals hold the true numbers.

    python docs/scripts/calibration_figure.py [DRAWS]

Measurements are made of a rig whose numbers differ from those of its file, on a finer mesh than that of the fit, with
noise.  A calibration of them is shown; then DRAWS more (2000) are fitted, on a surface of second degree through the
results of 36 rigs about the true numbers.
"""

import itertools
import shutil
import sys
import tempfile
import time
from functools import partial
from pathlib import Path
from typing import NamedTuple

import numpy as np
from scipy import stats

import beltdyn as bd
from beltdyn.arrays import FloatArray
from beltdyn.cli.output import show_result
from beltdyn.designs.calibrate import fit
from beltdyn.designs.designs import free_numbers
from beltdyn.designs.residuals import Residuals
from beltdyn.model.parameter_study import CalibrationStudy
from beltdyn.model.toml import read_study
from beltdyn.show.plot.style import INK, new_figure, styled

PAGES = Path(__file__).parents[1]
RIG, STUDY = (PAGES / "verification" / name for name in ("belt_rig.toml", "belt_rig_study.toml"))
PICTURE = PAGES / "_static" / "verification" / "calibration.svg"
SURE = 0.99
"""Confidence of the intervals of a coverage."""
CHECKED = 3
"""Random points at which the surface is compared with the rig."""
FINE = 2e-3
"""Error of contact forces of the measured rig; a fit has 1 %."""


class Unknown(NamedTuple):
    """A number of the rig that is fitted."""

    label: str
    true: float
    """SI."""


DEGREE = np.pi / 180.0
NUMBERS = {
    "belt.axial_stiffness": Unknown("EA", 64e3),
    "belt.bending_stiffness": Unknown("EI", 0.066),
    "belt.stretch_damping_time": Unknown("belt damping", 0.12e-3),
    "contact.friction": Unknown("friction", 0.38),
    "tensioner[idler].damping": Unknown("arm damping", 0.11),
    "tensioner[idler].rate": Unknown("arm rate", 0.43 / DEGREE),
    "tensioner[idler].preload": Unknown("arm preload", 10.4),
}
"""By their paths, in the order of the study."""


class Table(NamedTuple):
    """A table of measurements."""

    name: str
    heading: str
    """What differs from row to row."""
    rows: list[float]
    results: dict[str, tuple[float, float]]
    """Heading -> standard deviation, as part of the value and beside it."""


TABLES = (
    Table(
        "rest",
        "belt.installed_tension [N]",
        [150.0, 200.0, 250.0, 300.0],
        {
            "frequency[motor-idler] [Hz]": (0.003, 0.0),
            "frequency[idler-brake] [Hz]": (0.003, 0.0),
            "tensioner_position[idler] [rad]": (0.0, 0.1 * DEGREE),
            "mode_damping_ratio[1]": (0.03, 0.0),
            "mode_damping_ratio[2]": (0.03, 0.0),
        },
    ),
    Table(
        "slip",
        "brake torque [N m]",
        [-2.0, -4.0, -6.0, -8.0, -10.0],
        {"pulley_slip[brake]": (0.0, 4e-5)},
    ),
    Table("pull", "brake speed [rpm]", [1450.0, 1400.0], {"shaft_torque[motor] [N m]": (0.01, 0.0)}),
)


def write(folder: Path, values: FloatArray, deviations: FloatArray) -> None:
    """Write the tables, with values and deviations row by row."""
    left = iter(zip(values.tolist(), deviations.tolist(), strict=True))
    for table in TABLES:
        headings = [name for result in table.results for name in (result, f"± {result}")]
        lines = [", ".join([table.heading, *headings])]
        for row in table.rows:
            cells = [str(cell) for _ in table.results for cell in next(left)]
            lines.append(", ".join([str(row), *cells]))
        (folder / f"{table.name}.csv").write_text("\n".join(lines), encoding="utf-8")


def sizes(values: FloatArray) -> FloatArray:
    """Standard deviations of exact values, in the order of the tables."""
    parts = np.array([part for table in TABLES for _ in table.rows for part in table.results.values()])
    return np.asarray(parts[:, 0] * np.abs(values) + parts[:, 1])


def residuals_in(folder: Path, drive: bd.Drive, study: CalibrationStudy, tolerance: float | None) -> Residuals:
    """Residuals against the tables of a folder."""
    return Residuals(drive, free_numbers(drive, study.numbers), study, folder, tolerance, None)


class Surface(NamedTuple):
    """Residuals of the rig as a polynomial of second degree, in units of the standard errors of all numbers."""

    true: FloatArray
    """True numbers, by parts of the ways between their bounds, shape (n,)."""
    scale: FloatArray
    """Change of these parts by the units, shape (n, n)."""
    value: FloatArray
    slope: FloatArray
    """Shape (m, n)."""
    bend: FloatArray
    """Shape (m, n, n)."""

    def units(self, parts: FloatArray) -> FloatArray:
        """Numbers as units."""
        return np.asarray(np.linalg.solve(self.scale, parts - self.true))

    def residuals(self, parts: FloatArray) -> FloatArray:
        """Residuals without noise."""
        there = self.units(parts)
        return np.asarray(self.value + self.slope @ there + 0.5 * (self.bend @ there) @ there)

    def jacobian(self, parts: FloatArray) -> FloatArray:
        """Derivatives of the residuals."""
        return np.asarray((self.slope + self.bend @ self.units(parts)) @ np.linalg.inv(self.scale))


def surface_of(fitting: Residuals, true: FloatArray) -> Surface:
    """The surface through the rig at a standard error from the true numbers, to both sides and for two at a time."""
    slopes = fitting.jacobian(true)
    scale = np.linalg.cholesky(np.linalg.inv(slopes.T @ slopes))
    count, middle = true.size, fitting.residuals(true)
    units = np.eye(count)
    ahead, behind = (np.array([fitting.residuals(true + s * scale @ one) for one in units]) for s in (1.0, -1.0))
    slope, bend = (0.5 * (ahead - behind)).T, np.zeros((middle.size, count, count))
    for one in range(count):
        bend[:, one, one] = ahead[one] + behind[one] - 2.0 * middle
    for one, other in itertools.combinations(range(count), 2):
        both = fitting.residuals(true + scale @ (units[one] + units[other]))
        mixed = both - ahead[one] - ahead[other] + middle
        bend[:, one, other] = bend[:, other, one] = mixed
    return Surface(true, scale, middle, slope, bend)


def held(folder: Path, drive: bd.Drive, study: CalibrationStudy, exact: FloatArray, draws: int) -> FloatArray:
    """Errors of fits to noise over their standard errors, shape (draws, numbers)."""
    write(folder, exact, sizes(exact))
    fitting = residuals_in(folder, drive, study, None)
    fitting.start()
    frees = free_numbers(drive, study.numbers)
    pairs = zip(NUMBERS.values(), frees, strict=True)
    true = np.array([(one.true - free.least) / (free.largest - free.least) for one, free in pairs])
    surface, rng, found = surface_of(fitting, true), np.random.default_rng(15), []
    for _ in range(CHECKED):
        there = true + surface.scale @ rng.standard_normal(true.size)
        away = np.max(np.abs(surface.residuals(there) - fitting.residuals(there)))
        sys.stdout.write(f"the surface misses the rig by {away:.3f} deviations\n")
    for _ in range(draws):
        noise = rng.standard_normal(exact.size)
        noisy = partial(lambda parts, noise: surface.residuals(parts) - noise, noise=noise)
        one = fit(noisy, surface.jacobian, true, study.confidence, known=True)
        found.append((one.numbers - true) / one.errors)
    return np.array(found)


@styled
def draw(result: bd.Result, ratios: FloatArray) -> None:
    """Intervals of the one calibration, and the coverage of many over their confidence."""
    figure = new_figure((8.6, 3.6))
    left, right = figure.subplots(1, 2)
    data, rows = result.dataset, np.arange(len(NUMBERS))
    true = np.array([one.true for one in NUMBERS.values()])
    centre, reach = data.fitted.values / true, (data.upper.values - data.fitted.values) / true
    left.errorbar(centre, rows, xerr=reach, fmt="o", capsize=3, label=f"fitted, {data.confidence:.0%}")
    left.plot(data.start.values / true, rows, "x", label="drive file")
    left.axvline(1.0, color=INK, linewidth=0.8)
    left.set(xlabel="Over the true number", yticks=rows, yticklabels=[one.label for one in NUMBERS.values()])
    left.invert_yaxis()
    left.legend(loc="upper center", bbox_to_anchor=(0.5, -0.2), ncols=2)
    nominal = np.linspace(0.02, 0.99, 98)
    for one, ratio in zip(NUMBERS.values(), np.abs(ratios).T, strict=True):
        right.plot(nominal, [np.mean(ratio <= stats.norm.ppf(0.5 + 0.5 * c)) for c in nominal], label=one.label)
    ends = np.array([np.array(stats.binom.interval(SURE, len(ratios), c)) / len(ratios) for c in nominal])
    right.fill_between(nominal, ends[:, 0], ends[:, 1], color="0.9", zorder=0)
    right.set(xlabel="Confidence", ylabel=f"Part of {len(ratios)} intervals that hold the true number")
    right.legend(loc="center left", bbox_to_anchor=(1.0, 0.5))
    PICTURE.parent.mkdir(parents=True, exist_ok=True)
    figure.savefig(PICTURE, metadata={"Date": None})


def main() -> None:
    """Measure, calibrate, repeat, and print."""
    draws, begun = int(sys.argv[1]) if len(sys.argv) > 1 else 2000, time.process_time()
    drive, study = bd.load(str(RIG)), read_study(STUDY, CalibrationStudy)
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        count = sum(len(table.rows) * len(table.results) for table in TABLES)
        write(folder, np.ones(count), np.ones(count))
        true = drive.with_({path: one.true for path, one in NUMBERS.items()})
        measured = residuals_in(folder, true, study, FINE)
        measured.start()
        exact = measured.first
        noisy = exact + sizes(exact) * np.random.default_rng(1).standard_normal(count)
        write(folder, noisy, sizes(exact))
        result = bd.calibrate(drive, study=shutil.copy(STUDY, folder))
        show_result(result)
        sys.stdout.write(f"{time.process_time() - begun:.0f} s of one core\n")
        ratios = held(folder, drive, study, exact, draws)
    for one, ratio in zip(NUMBERS.values(), np.abs(ratios).T, strict=True):
        inside = int(np.sum(ratio <= stats.norm.ppf(0.5 + 0.5 * study.confidence)))
        low, high = stats.binomtest(inside, draws).proportion_ci(SURE)
        spread = float(np.sqrt(np.mean(ratio**2)))
        sys.stdout.write(f"{one.label:14} {inside / draws:.3f} ({low:.3f} to {high:.3f}), errors {spread:.3f}\n")
    sys.stdout.write(f"{time.process_time() - begun:.0f} s of one core\n")
    draw(result, ratios)


if __name__ == "__main__":
    main()

"""The promise of the tolerance, held by a matrix of runs: each lands within it, or stops with a clear error.

The error of a run is that of the driven speed, root mean square over the run, over the largest speed of the driver;
the reference is a run on the same mesh from the same start by generalized-alpha at rtol 1e-5.  From equilibrium contact
is integrated over the touching zone; laid drives are as published, with fixed Gauss points.
"""

import re
from collections.abc import Callable, Iterator, Sequence
from functools import partial
from itertools import product
from pathlib import Path
from typing import Any, NamedTuple

import h5py
import numpy as np
import pytest

from beltdyn import Drive, Pulley
from beltdyn.designs.batch import simulate_all
from beltdyn.model import CosineRamp, CosineRampPublished, Ramp
from beltdyn.results.checks.power import CLOSURE_LIMIT, GROWTH_LIMIT
from beltdyn.results.energy_balance import largest_closure
from beltdyn.results.schema import attribute
from validation.published import CASES as PUBLISHED
from validation.published import better, loaded_two_pulley, two_pulley

RTOLS = (1e-2, 1e-3, 1e-4)
DEFAULT_RTOL = 1e-3
REFERENCE = 1e-5
RADII = (0.0, 0.6, 0.8, 1.0)
DEFAULT = 0.6
CASES: dict[str, Callable[[int], Drive]] = {
    "case 1": two_pulley,
    "case 2, 1e4": partial(loaded_two_pulley, 1e4, 5),
    "case 2, 1e5": partial(loaded_two_pulley, 1e5, 5),
}
ELEMENTS = (12, 16, 20, 30, 60, 120)
DURATIONS = {"equilibrium": 0.4, "laid": 0.2}
"""Of the published second, s: the laid belt rings, and the drive starts."""
PROMISE = 2.0
"""Largest error over rtol in cases 1 and 2."""
FLUTTER = {"equilibrium": 1e-3, "laid": 2.5e-3}
"""What may be added to the error of a run that warns of flutter, over the speed of the driver: where the belt slides
vibrations grow, which changes its speed, and which steps damp away unless rtol is 1e-5 and the spectral radius above
zero (tests/verification/theory/test_sliding_flutter.py)."""
SURE, COARSE = 20, 30
"""Elements up to which no run warns of it, and up to which errors fall in proportion whether it does or not."""
DAMPING = {"damped": 100.0, "well damped": 1000.0}
"""Contact damping with which vibrations hardly grow, and with which they do not, N s/m^2; 10 is published."""
STANDARD = {"cvode": (12, 20, 30), "ida": (12, 20, 30), "bdf": (12,), "radau": (12,)}
"""Integrators with dense matrices, and elements from equilibrium; laid belts, which ring, have 12."""
BEGINNINGS = {"equilibrium": 0.1, "laid": 0.015}
"""Of a drive whose driver starts at once, s."""
PROMISE_OF_ALL = 5.0
"""Largest error over rtol in every published case."""
REJECTED = 0.02
"""Largest part of the steps of a published case that may be rejected, at the default tolerance."""
MANY_POINTS = 11
"""Fixed points of an element where there are less than 20 elements.  With 5 the drive does not know its own speed: a
belt longer by a billionth changes it by 1e-4, since points touch or do not."""
CLEAR = re.compile(r"the simulation fails at t = .* Try a simulation\.spectral_radius below 1, ")


class Key(NamedTuple):
    """What tells the runs of the matrix apart."""

    case: str
    start: str
    elements: int
    radius: float
    rtol: float
    kind: str = ""
    """Empty, of `DAMPING`, or for beginnings of a drive the integrator."""

    @property
    def reference(self) -> "Key":
        kind = "generalized_alpha" if self.kind in STANDARD else self.kind
        return self._replace(radius=DEFAULT, rtol=REFERENCE, kind=kind)

    def __str__(self) -> str:
        return f"{self.case} {self.start} {self.elements} {self.radius:g} {self.rtol:g} {self.kind}"


def keys_of(case: str, start: str, radius: float) -> Iterator[Key]:
    return (Key(case, start, *items) for items in product(ELEMENTS, (radius,), RTOLS))


def damped_keys(start: str, elements: Sequence[int], radius: float, kind: str = "damped") -> Iterator[Key]:
    return (Key("case 1", start, *items, kind) for items in product(elements, (radius,), RTOLS))


DAMPED = [*damped_keys("equilibrium", ELEMENTS, DEFAULT), *damped_keys("laid", (60,), 0.0)]
"""All meshes, and a run whose error is mostly that of flutter with the published damping."""
WELL_DAMPED = [key for start in DURATIONS for key in damped_keys(start, (60, 120), DEFAULT, "well damped")]


def standard_keys(case: str, start: str, integrator: str) -> Iterator[Key]:
    elements = STANDARD[integrator] if start == "equilibrium" else (12,)
    items = product(elements, (DEFAULT,), RTOLS, (integrator,))
    return (Key(case, start, *item) for item in items)


def drive_of(key: Key) -> Drive:
    drive = CASES[key.case](key.elements)
    if key.start == "equilibrium":
        drive = better(drive)
    elif key.elements < 20:
        drive = drive.replace(contact=drive.contact.replace(quadrature_points=MANY_POINTS))
    settings: dict[str, Any] = {"rtol": key.rtol, "spectral_radius": key.radius, "duration": DURATIONS[key.start]}
    if key.kind in DAMPING:
        drive = drive.replace(contact=drive.contact.replace(damping=DAMPING[key.kind]))
    elif key.kind:
        settings |= {"integrator": key.kind, "duration": BEGINNINGS[key.start]}
        drive = drive.replace(pulley=[at_once(pulley) for pulley in drive.pulleys])
    return drive.replace(simulation=drive.simulation.replace(**settings))


def at_once(pulley: Pulley) -> Pulley:
    """A pulley whose speed or torque rises from time zero, as steeply."""
    name, profile = ("speed", pulley.speed) if pulley.speed else ("torque", pulley.torque)
    assert isinstance(profile, Ramp | CosineRamp | CosineRampPublished)
    return pulley.replace(**{name: profile.replace(start=0.0, end=profile.end - profile.start)})


class Runs(NamedTuple):
    """What was found in the runs that were completed, by name, and why others were not."""

    speeds: dict[str, np.ndarray]
    """Of the pulleys, rad/s."""
    growth: dict[str, float]
    """Of vibrations where the belt slides, as the logarithm of a factor."""
    rejected: dict[str, float]
    """Part of the steps tried that was rejected."""
    missing: dict[str, float]
    """Largest part of the energy put in that the account misses."""
    failures: dict[str, str]

    def warns(self, key: Key) -> bool:
        """Whether a run warns that its belt may flutter."""
        return self.growth[str(key)] > GROWTH_LIMIT

    def adds_up(self, key: Key) -> bool:
        """Whether a run does not warn that its energies do not add up."""
        return abs(self.missing[str(key)]) <= CLOSURE_LIMIT

    def promise(self, key: Key) -> float:
        """Largest error of a run over the speed of the driver."""
        return PROMISE * key.rtol + (FLUTTER[key.start] if self.warns(key) else 0.0)


def run_all(drives: dict[str, Drive], folder: Path) -> Runs:
    paths = {name: folder / f"{name}.nc" for name in drives}
    endings = simulate_all({paths[name]: drive for name, drive in drives.items()})
    runs = Runs({}, {}, {}, {}, {name: endings[path].error for name, path in paths.items() if endings[path].error})
    for name in drives.keys() - runs.failures:
        with h5py.File(paths[name], "r") as file:
            runs.speeds[name] = file["pulley_speed"][...]
            runs.growth[name] = attribute(file, "flutter_growth", 0.0)
            steps, rejected = (attribute(file, count, np.nan) for count in ("steps", "rejected_steps"))
            runs.rejected[name] = rejected / (steps + rejected)
            runs.missing[name] = largest_closure(file).error
    return runs


def run_keys(keys: list[Key], folder: Path) -> Runs:
    """Runs and their references."""
    return run_all({str(key): drive_of(key) for key in [*keys, *(key.reference for key in keys)]}, folder)


def error(runs: Runs, name: str, reference: str) -> float:
    """Largest error of the driven speed of a run: several pulleys may be driven."""
    speed, exact = runs.speeds[name], runs.speeds[reference]
    errors = np.sqrt(np.mean((speed[:, 1:] - exact[:, 1:]) ** 2, axis=0))
    return float(errors.max() / np.abs(exact[:, 0]).max())


@pytest.fixture(scope="session")
def matrix(tmp_path_factory: pytest.TempPathFactory) -> Runs:
    """All runs of the matrix, and their references."""
    keys = [key for group in product(CASES, DURATIONS, RADII) for key in keys_of(*group)]
    return run_keys([*keys, *DAMPED, *WELL_DAMPED], tmp_path_factory.mktemp("matrix"))


@pytest.fixture(scope="session")
def standard(tmp_path_factory: pytest.TempPathFactory) -> Runs:
    """All runs by standard integrators, and their references."""
    keys = [key for group in product(CASES, BEGINNINGS, STANDARD) for key in standard_keys(*group)]
    return run_keys(keys, tmp_path_factory.mktemp("standard"))


@pytest.fixture(scope="session")
def published(tmp_path_factory: pytest.TempPathFactory) -> Runs:
    """All published cases over their whole duration, with the settings that serve better, and as published."""
    kinds = product(PUBLISHED, (*RTOLS, REFERENCE))
    drives = {f"{name} {rtol:g}": better(PUBLISHED[name].build(), rtol=rtol) for name, rtol in kinds}
    drives |= {name: case.build() for name, case in PUBLISHED.items()}
    return run_all(drives, tmp_path_factory.mktemp("published"))


@pytest.mark.parametrize("radius", RADII)
@pytest.mark.parametrize("start", DURATIONS)
@pytest.mark.parametrize("case", CASES)
def test_every_run_lands_or_stops(
    matrix: Runs, measured: Callable[..., None], curve: Callable[..., None], case: str, start: str, radius: float
) -> None:
    """Without numerical damping and with coarse tolerances a run may stop, or miss with energies that do not close."""
    keys = list(keys_of(case, start, radius))
    stopped = [key for key in keys if str(key) in matrix.failures]
    ratios = {key: error(matrix, str(key), str(key.reference)) / key.rtol for key in keys if key not in stopped}
    largest = {rtol: max((ratio for key, ratio in ratios.items() if key.rtol == rtol), default=0.0) for rtol in RTOLS}
    measured(**{f"rtol_{rtol:.0e}": ratio for rtol, ratio in largest.items()}, stopped=len(stopped))
    landed = {rtol: ratio * rtol for rtol, ratio in largest.items() if ratio > 0.0}
    curve(f"matrix/{start}", list(landed), list(landed.values()), f"{case}, ρ = {radius:g}")
    missed = [key for key, ratio in ratios.items() if ratio > matrix.promise(key) / key.rtol]
    assert not any(matrix.adds_up(key) for key in missed)
    assert all(CLEAR.match(matrix.failures[str(key)]) for key in stopped)
    assert all(key.radius == 1.0 and key.rtol > RTOLS[-1] for key in (*stopped, *missed))


@pytest.mark.parametrize("radius", RADII)
@pytest.mark.parametrize("case", CASES)
def test_errors_fall_in_proportion(
    matrix: Runs, measured: Callable[..., None], order: Callable[..., float], case: str, radius: float
) -> None:
    """From equilibrium.  A laid belt rings so fast that coarse tolerances damp it away, and err less than they may."""
    fitted = []
    for elements in ELEMENTS:
        keys = [key for key in keys_of(case, "equilibrium", radius) if key.elements == elements]
        landed = [key for key in keys if str(key) not in matrix.failures]
        if elements > COARSE and any(matrix.warns(key) for key in landed):
            continue
        errors = [error(matrix, str(key), str(key.reference)) for key in landed]
        fitted.append(-order([key.rtol for key in landed], errors))
    measured(smallest=min(fitted), median=float(np.median(fitted)), largest=max(fitted))
    assert min(fitted) > 0.75


def test_no_exceptions_where_flutter_is_damped(
    matrix: Runs, measured: Callable[..., None], order: Callable[..., float]
) -> None:
    """With the contact damping that its belt needs where it slides, case 1 keeps the promise on all meshes."""
    errors = {key: error(matrix, str(key), str(key.reference)) for key in DAMPED}
    fitted = [
        -order(RTOLS, [errors[key] for key in damped_keys("equilibrium", (elements,), DEFAULT)])
        for elements in ELEMENTS
    ]
    largest = max(value / key.rtol for key, value in errors.items())
    measured(smallest=min(fitted), largest=max(fitted), largest_error=largest)
    assert min(fitted) > 0.75
    assert all(value <= PROMISE * key.rtol for key, value in errors.items())


@pytest.mark.parametrize("elements", ELEMENTS)
@pytest.mark.parametrize("start", DURATIONS)
@pytest.mark.parametrize("case", CASES)
def test_runs_that_miss_say_so(
    matrix: Runs, measured: Callable[..., None], case: str, start: str, elements: int
) -> None:
    """A run is warned of where its belt flutters, which it does in case 1 if the mesh can carry the waves."""
    keys = [key for radius in RADII for key in keys_of(case, start, radius) if key.elements == elements]
    landed = [key for key in keys if str(key) not in matrix.failures]
    growth = [matrix.growth[str(key)] for key in landed]
    ratios = {key: error(matrix, str(key), str(key.reference)) / key.rtol for key in landed}
    measured(least=min(growth), median=float(np.median(growth)), most=max(growth), largest_ratio=max(ratios.values()))
    assert all(matrix.warns(key) or not matrix.adds_up(key) for key, ratio in ratios.items() if ratio > PROMISE)
    assert case == "case 1" or not any(matrix.warns(key) for key in landed)
    assert elements > SURE or not any(matrix.warns(key) for key in landed)


def test_runs_with_enough_damping_do_not_warn(matrix: Runs, measured: Callable[..., None]) -> None:
    for kind, keys in (("damped", DAMPED), ("well_damped", WELL_DAMPED)):
        measured(
            **{f"{kind}_{start}": max(matrix.growth[str(k)] for k in keys if k.start == start) for start in DURATIONS}
        )
    assert not any(matrix.warns(key) for key in WELL_DAMPED)


@pytest.mark.parametrize("integrator", STANDARD)
@pytest.mark.parametrize("start", BEGINNINGS)
@pytest.mark.parametrize("case", CASES)
def test_every_standard_integrator_lands(
    standard: Runs, measured: Callable[..., None], case: str, start: str, integrator: str
) -> None:
    keys = list(standard_keys(case, start, integrator))
    assert not standard.failures.keys() & {str(key) for key in keys}
    ratios = {key: error(standard, str(key), str(key.reference)) / key.rtol for key in keys}
    measured(**{f"rtol_{rtol:.0e}": max(ratios[key] for key in keys if key.rtol == rtol) for rtol in RTOLS})
    assert max(ratios.values()) <= PROMISE


@pytest.mark.parametrize("name", PUBLISHED)
def test_published_cases_land(published: Runs, measured: Callable[..., None], name: str) -> None:
    ratios = {rtol: error(published, f"{name} {rtol:g}", f"{name} {REFERENCE:g}") / rtol for rtol in RTOLS}
    growth = max(published.growth[f"{name} {rtol:g}"] for rtol in RTOLS)
    measured(**{f"rtol_{rtol:.0e}": ratio for rtol, ratio in ratios.items()}, growth=growth)
    assert max(ratios.values()) <= PROMISE_OF_ALL


@pytest.mark.parametrize("name", PUBLISHED)
def test_hardly_a_step_is_rejected(published: Runs, measured: Callable[..., None], name: str) -> None:
    shares = {"published": published.rejected[name], "better": published.rejected[f"{name} {DEFAULT_RTOL:g}"]}
    measured(**shares)
    assert max(shares.values()) < REJECTED

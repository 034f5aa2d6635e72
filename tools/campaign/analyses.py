"""Every analysis of a drive, short, with the files that it needs."""

from collections.abc import Callable
from pathlib import Path

import beltdyn as bd
from beltdyn.analyses import ANALYSES, Analysis
from beltdyn.model import Drive, ParameterStudy
from beltdyn.model.parameter_study import CalibrationStudy, OptimizationStudy

Work = Callable[[Drive, Path], object]


def table_in(folder: Path) -> Path:
    """A duty table in a folder."""
    table = folder / "duty.csv"
    table.write_text("duration [s], load\n1, 0.5\n1, 0\n0, 2\n", encoding="utf-8")
    return table


def _duty(drive: Drive, folder: Path) -> object:
    return bd.duty(drive, table=table_in(folder))


def _width(drive: Drive) -> dict[str, object]:
    """The belt's width as a free number."""
    return {"path": "belt.width", "least": 0.8 * drive.belt.width, "largest": 1.2 * drive.belt.width}


def _optimized(drive: Drive, folder: Path) -> object:
    study = OptimizationStudy(
        number=[_width(drive)],
        goal={"result": "hub_load"},
        requirement=[{"result": "slip_safety", "at_least": 1.5}],
    )
    return bd.optimize(drive, study=study, most=2)


def _calibrated(drive: Drive, folder: Path) -> object:
    table = folder / "measured.csv"
    table.write_text(f"{drive.pulleys[-1].name} torque [N m], efficiency\n-1, 0.95\n-2, 0.9\n", encoding="utf-8")
    study = CalibrationStudy(number=[_width(drive)], measurement=[{"table": str(table)}])
    return bd.calibrate(drive, study=study)


def _studied(drive: Drive, folder: Path) -> object:
    points = ParameterStudy(
        analysis="steady_state",
        number=[{"path": "belt.width", "values": [0.8 * drive.belt.width, drive.belt.width]}],
        results=["efficiency"],
    )
    return bd.study(points, drive, jobs=1, output=folder / "study.nc")


def driver_name(drive: Drive) -> str:
    """Name of the pulley with a prescribed speed, or of the first."""
    return next((one.name for one in drive.pulleys if one.prescribed), drive.pulleys[0].name)


def _lives(drive: Drive, folder: Path) -> object:
    return bd.life(drive, table=table_in(folder))


def _as_it_is(analysis: Analysis) -> Work:
    return lambda drive, _: analysis.function(drive)


WORKS: dict[str, Work] = {one.command: _as_it_is(one) for one in ANALYSES.values()} | {
    "check": lambda drive, _: str(bd.check(drive)),
    "check by closed forms": lambda drive, _: str(bd.check(drive, equilibrium=False)),
    "simulate": lambda drive, folder: bd.simulate(drive, output=folder / "run.nc"),
    "sweep": lambda drive, _: bd.sweep(
        drive, pulley=driver_name(drive), from_="50 rad/s", to="60 rad/s", duration=0.003, settling=0.001
    ),
    "operating-map": lambda drive, folder: bd.operating_map(
        drive, speed="0, 500, 1e5 rpm", load="0, 1", output=folder / "map.nc"
    ),
    "traction": lambda drive, _: bd.traction(drive, pulley=drive.pulleys[-1].name, slip="0, 0.2, 5 %"),
    "duty": _duty,
    "life": _lives,
    "sheet": lambda drive, folder: bd.sheet(drive, table=table_in(folder), points=3),
    "sensitivity": lambda drive, _: bd.sensitivity(
        drive, numbers=f"belt.width, pulley[{drive.pulleys[0].name}].radius"
    ),
    "modes": lambda drive, _: bd.modes(drive, count=3),
    "modes at rest": lambda drive, _: bd.modes(drive, about="rest", count=3),
    "optimize": _optimized,
    "calibrate": _calibrated,
    "campbell": lambda drive, _: bd.campbell(drive, speed="0, 500, 1e4 rpm", count=2),
    "response": lambda drive, _: bd.response(drive, speed="0, 500, 1e4 rpm"),
    "stroke": lambda drive, _: bd.stroke(drive, points=2),
    "study": _studied,
}
"""Name -> what is done with a drive, in a folder of its own."""

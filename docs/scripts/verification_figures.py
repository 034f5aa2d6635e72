"""Draw the figures of docs/verification from the curves of the verification tests.

    python docs/scripts/verification_figures.py [CURVES]

runs the verification tests that draw curves, slow ones too, and those of tolerance, ripple and the published drive (a
quarter of an hour), or takes a file that `pytest --curves FILE` has written, and draws docs/_static/verification/*.svg.
"""

import json
import subprocess
import sys
import tempfile
from pathlib import Path
from typing import Any, NamedTuple

import matplotlib as mpl
from matplotlib.axes import Axes

import beltdyn as bd
from beltdyn.show.plot.style import COLORS, dash, new_figure, styled
from validation.published.released_belt import released_belt

ROOT = Path(__file__).parents[2]
FOLDER = ROOT / "docs" / "_static" / "verification"
TESTS = (
    "tests/verification",
    "tests/validation/test_matrix.py",
    "tests/validation/test_ripple.py",
    "tests/validation/test_published_benchmarks.py",
)
Curves = list[dict[str, Any]]


class Panel(NamedTuple):
    """Axes of a figure."""

    name: str
    x: str
    y: str
    scale: str = "loglog"
    slope: tuple[float, float, float, float] | None = None
    """Reference line: order, its first and last x, and its first y."""
    below: bool = False
    """Whether the legend stands below the axes."""


ELEMENTS, STEPS = "Elements", "Steps"
RTOL = "rtol"
FIGURES: dict[str, list[Panel]] = {
    "roll_up": [Panel("", ELEMENTS, "Largest distance from the arc / L", slope=(4, 8, 32, 4e-4))],
    "elastica": [
        Panel("tip", "P L² / EI", "Tip", "linear"),
        Panel("mesh", ELEMENTS, "Largest error", slope=(4, 16, 64, 2e-4)),
    ],
    "released_belt": [
        Panel("iteration", "Iteration", "Step, as a mean strain", "semilogy"),
        Panel("radius", ELEMENTS, "Error of the radius", slope=(4, 10, 80, 8e-5)),
    ],
    "generalized_alpha": [
        Panel("order", STEPS, "Error over the amplitude", slope=(2, 200, 800, 1e-2)),
        Panel("radius", "ρ∞ asked for", "Spectral radius found", "linear"),
    ],
    "integrators": [Panel("", RTOL, "Difference to Radau at 1e-5", slope=(1, 1e-5, 1e-3, 2e-5))],
    "matrix": [
        Panel("equilibrium", RTOL, "Largest error, from equilibrium", slope=(1, 1e-4, 1e-2, 1e-4), below=True),
        Panel("laid", RTOL, "Largest error, laid", slope=(1, 1e-4, 1e-2, 2e-4), below=True),
    ],
    "torque_ripple": [
        Panel("1e+04", "Frequency [Hz]", "Amplitude / load, ν_s = 1e4", "semilogy", below=True),
        Panel("1e+05", "Frequency [Hz]", "Amplitude / load, ν_s = 1e5", "semilogy", below=True),
    ],
    "energy": [
        Panel("small", RTOL, "Largest closure error, small drive", slope=(1, 1e-5, 1e-3, 6e-6), below=True),
        Panel("cases", RTOL, "Largest closure error, published", slope=(1, 1e-4, 1e-3, 3e-5), below=True),
        Panel("integrators", RTOL, "Largest closure error, laid, 20 ms", slope=(1, 1e-5, 1e-3, 1e-5), below=True),
    ],
    "capstan": [
        Panel("ratio", "Angle between the spans [°]", "Ratio of the tensions", "linear", below=True),
        Panel("error", "Angle between the spans [°]", "Error of the ratio", "semilogy", below=True),
    ],
    "hoop": [Panel("", ELEMENTS, "Relative error", slope=(4, 10, 40, 2e-3))],
    "static_tension": [Panel("", ELEMENTS, "Relative error of the span tension")],
    "running_drive_1e4": [
        Panel("friction_force_driver_1e+04", "Angle on the driver [°]", "Friction force [N/m]", "linear"),
        Panel("friction_force_driven_1e+04", "Angle on the driven pulley [°]", "", "linear"),
        Panel("normal_force_driver_1e+04", "Angle on the driver [°]", "Normal force [N/m]", "linear"),
        Panel("normal_force_driven_1e+04", "Angle on the driven pulley [°]", "", "linear"),
    ],
    "running_drive_1e5": [
        Panel("friction_force_driver_1e+05", "Angle on the driver [°]", "Friction force [N/m]", "linear"),
        Panel("friction_force_driven_1e+05", "Angle on the driven pulley [°]", "", "linear"),
        Panel("normal_force_driver_1e+05", "Angle on the driver [°]", "Normal force [N/m]", "linear"),
        Panel("normal_force_driven_1e+05", "Angle on the driven pulley [°]", "", "linear"),
    ],
    "running_drive_error": [
        Panel("1e+04", ELEMENTS, "Error for ν_s = 1e4", slope=(3, 30, 120, 5e-2), below=True),
        Panel("1e+05", ELEMENTS, "Error for ν_s = 1e5", slope=(3, 30, 120, 5e-2), below=True),
    ],
    "hysteresis": [
        Panel("torque", "Radius of both pulleys [mm]", "Torque lost in bending [N m]", "linear"),
        Panel("efficiency", "Pull at the belt [N]", "Efficiency [%]", "linear"),
    ],
    "elastic_creep": [
        Panel("speed_loss", "Torque [N m]", "Loss of speed [%]", "linear"),
        Panel("slip_arc", "Torque [N m]", "Arc of sliding [°]", "linear"),
        Panel("gross_slip", "Time [s]", "Driven pulley [rad/s]", "linear"),
    ],
    "creep_rate_law": [
        Panel("driver", "Angle from the inlet of the driver [°]", "Slip velocity / v_c", "linear"),
        Panel("driven", "Angle from the inlet of the driven pulley [°]", "", "linear"),
    ],
    "conveyor": [
        Panel("start", "Time [s]", "Rim speed, start [m/s]", "linear"),
        Panel("stop", "Time [s]", "Rim speed, stop [m/s]", "linear"),
    ],
    "toothed": [Panel("", "Place on the arc [mm]", "Load of a tooth [N]", "linear")],
    "nip": [
        Panel("pressure", "Distance from the line of centers [mm]", "Pressure [kPa]", "linear"),
        Panel("shear", "Distance from the line of centers [mm]", "Shear on the belt [kPa]", "linear"),
    ],
    "web_draw": [Panel("", "Time [s]", "Tension [N]", "linear")],
    "web_ripple": [Panel("", "Frequency [Hz]", "Amplitude of the tension [N]")],
    "web_control": [Panel("", "Time [s]", "Tension [N]", "linear")],
    "published_drive": [
        Panel("speed", "Time [s]", "Driven pulley [rad/s]", "linear"),
        Panel("arc", "Angle on the driven pulley [°]", "Tension [N]", "linear"),
    ],
}


def measure(file: Path) -> None:
    """Run the tests that draw curves; failing ones are told, and leave their curves out."""
    command = [sys.executable, "-m", "pytest", "-q", "--curves", str(file), *TESTS]
    subprocess.run(command, cwd=ROOT)


def draw_panel(ax: Axes, panel: Panel, curves: Curves) -> None:
    """Draw curves; single points of equal label are joined."""
    ax.set(xlabel=panel.x, ylabel=panel.y)
    if panel.scale == "loglog":
        ax.set(xscale="log", yscale="log")
    elif panel.scale == "semilogy":
        ax.set_yscale("log")
    for number, label in enumerate(dict.fromkeys(curve["label"] for curve in curves)):
        same = [curve for curve in curves if curve["label"] == label]
        if all(len(curve["x"]) == 1 for curve in same):
            joined = {axis: [curve[axis][0] for curve in same] for axis in "xy"}
            same = [same[0] | joined]
        for curve in same:
            text = label.replace("_", " ") if curve is same[0] else None
            line = ax.plot(curve["x"], curve["y"], curve["style"], label=text, markersize=4)[0]
            if curve["style"] == "o-":
                line.set_linestyle(dash(number // len(COLORS)))
    if panel.slope is not None:
        order, first, last, start = panel.slope
        sign = 1.0 if first < 1.0 else -1.0  # errors fall with the tolerance, and with the number of elements
        end = start * (last / first) ** (sign * order)
        ax.plot([first, last], [start, end], color="0.6", linewidth=1.0, label=f"order {order:g}")
    if panel.x in (ELEMENTS, STEPS):
        ticks = sorted({value for curve in curves for value in curve["x"]})
        ax.set_xticks(ticks, [f"{tick:g}" for tick in ticks])
        ax.minorticks_off()
    if any(curve["label"] for curve in curves):
        below = {"loc": "upper center", "bbox_to_anchor": (0.5, -0.16), "ncols": 2, "handlelength": 3.5}
        ax.legend(**below if panel.below else {})


@styled
def draw(curves: dict[str, Curves]) -> None:
    """Draw all figures for which there are curves."""
    FOLDER.mkdir(parents=True, exist_ok=True)
    mpl.rcParams.update({"svg.hashsalt": "beltdyn", "svg.fonttype": "none", "text.parse_math": True})
    for name, panels in FIGURES.items():
        source = name.split("_1e")[0]
        keys = [f"{source}/{panel.name}" if panel.name else source for panel in panels]
        if not all(key in curves for key in keys):
            sys.stderr.write(f"no curves for {name}\n")
            continue
        columns = 2 if len(panels) in (2, 4) else 1 if len(panels) == 1 else 3
        rows = -(-len(panels) // columns)
        width = 5.2 if columns == 1 else 8.6 if columns == 2 else 11.0
        figure = new_figure((width, (4.4 if any(panel.below for panel in panels) else 3.4) * rows))
        for ax, panel, key in zip(figure.subplots(rows, columns, squeeze=False).flat, panels, keys, strict=True):
            draw_panel(ax, panel, curves[key])
        figure.savefig(FOLDER / f"{name}.svg", metadata={"Date": None})


@styled
def draw_shapes() -> None:
    """Draw the iterations of the released belt."""
    mpl.rcParams.update({"svg.hashsalt": "beltdyn", "svg.fonttype": "none"})
    figure = new_figure((5.2, 4.4))
    bd.plot.iterations(bd.release(released_belt(), method="newton"), ax=figure.add_subplot())
    figure.savefig(FOLDER / "released_belt_shapes.svg", metadata={"Date": None})


def main() -> None:
    """Draw from a file of curves, or from a run of the tests."""
    draw_shapes()
    if len(sys.argv) > 1:
        file = Path(sys.argv[1])
        draw(json.loads(file.read_text(encoding="utf-8")))
        return
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "curves.json"
        measure(file)
        draw(json.loads(file.read_text(encoding="utf-8")))


if __name__ == "__main__":
    main()

"""Draw verification/waterfall.png: a run-up on both meshes (`python docs/scripts/frames_figure.py`, a minute).

The example alternator_drive from 500 to 1500 rpm of the crank in 1 s, whose crank turns evenly: what stands out is the
mesh's.
"""

import sys
from importlib.resources import files
from pathlib import Path
from typing import Literal, get_args

import numpy as np

import beltdyn as bd
from beltdyn.results.derived import element_order, waterfall
from beltdyn.show.plot.style import INK, new_figure, styled

FILE = Path(__file__).parents[1] / "_static" / "verification" / "waterfall.png"
ELEMENTS = 90
"""That travel."""
DECIBELS = -60.0, 20.0
RPM = np.pi / 30.0
FROM, ABOVE = 700.0, 300.0
"""Where levels are printed, rpm and Hz."""


Frame = Literal["travelling", "staying"]


def raised(frame: Frame) -> bd.Run:
    """The run-up."""
    drive = bd.load(str(files("beltdyn") / "examples" / "alternator_drive.toml"))
    belt = drive.belt.replace(elements=ELEMENTS if frame == "travelling" else None)
    settings = drive.simulation.replace(frame=frame, output_interval=4e-4, field_interval=0.1)
    given = drive.replace(belt=belt, simulation=settings)
    return bd.sweep(given, pulley="crank", from_=500.0 * RPM, to=1500.0 * RPM, duration=1.0, settling=0.5)


@styled
def draw() -> None:
    """Both waterfalls of the tension in the first span, side by side in the same colors."""
    figure = new_figure((8.6, 3.6))
    shown = None
    for ax, frame in zip(figure.subplots(1, 2, sharey=True), get_args(Frame), strict=True):
        run = raised(frame)
        tension, speed = run.dataset["filtered_span_tension"], run.dataset["pulley_speed"].sel(pulley="crank")
        levels = waterfall(tension.isel(span=0), speed, pieces=40)
        values = 20.0 * np.log10(np.maximum(levels.values, 1e-9))
        shown = ax.pcolormesh(levels["frequency"], levels["speed"] / RPM, values, vmin=DECIBELS[0], vmax=DECIBELS[1])
        title = (
            f"{ELEMENTS} elements that travel" if frame == "travelling" else f"{run.dataset.sizes['node']} that stay"
        )
        ax.set(xlabel="Frequency [Hz]", title=title)
        if frame == "travelling":
            ax.set_ylabel("Speed of the crank [rpm]")
            order, turning = element_order(run.drive, 0), np.array([500.0, 1500.0]) * RPM
            ax.plot(order * turning / (2.0 * np.pi), turning / RPM, color=INK, linestyle=":", linewidth=0.8)
        ax.set_xlim(0.0, float(levels["frequency"][-1]))
        fast = values[levels["speed"].values > FROM * RPM][:, levels["frequency"].values > ABOVE]
        sys.stdout.write(f"{title}: above {FROM:g} rpm and {ABOVE:g} Hz at most {fast.max():.0f} dB\n")
    figure.colorbar(shown, ax=figure.axes, label="Tension [dB re 1 N]")
    figure.savefig(FILE, dpi=120)


if __name__ == "__main__":
    draw()

"""Draw the pictures of README (the drive of `beltdyn demo`), theory (the paper's drive under load) and nips."""

from collections.abc import Callable, Mapping
from functools import partial
from pathlib import Path
from tempfile import TemporaryDirectory

from matplotlib.axes import Axes

import beltdyn as bd
from beltdyn.show.plot.style import new_figure, styled
from validation.published import demo_text

PICTURES = Path(__file__).parents[1] / "_static"


def loaded_drive() -> bd.Drive:
    """The two-pulley drive of the paper with 60 elements, from equilibrium, under a load of 0.5 N m, for 2 s."""
    drive = bd.loads(demo_text())
    driver, driven = drive.pulleys
    load = {"kind": "cosine_ramp", "start": 0.05, "end": 0.6, "value": -0.5}
    return drive.replace(
        belt=drive.belt.replace(elements=60),
        pulley=[driver, driven.replace(torque=load)],
        simulation=drive.simulation.replace(start="equilibrium", duration=2.0),
    )


@styled
def draw(run: bd.Run, panels: Mapping[str, Callable[..., Axes]], path: Path) -> None:
    """Draw the drive above two panels side by side.

    Parameters
    ----------
    run
        The run.
    panels
        Name -> figure of the two panels.
    path
        The PNG to write.
    """
    figure = new_figure((8.0, 6.8))
    axes = figure.subplot_mosaic([["drive", "drive"], [*panels]], height_ratios=(3, 2))
    bd.plot.configuration(run, ax=axes["drive"])
    for name, plot in panels.items():
        plot(run, ax=axes[name])
    figure.savefig(path, dpi=110, bbox_inches="tight")


if __name__ == "__main__":
    PICTURES.mkdir(exist_ok=True)
    fan = bd.simulate(bd.example("fan_direct_start"))
    draw(fan, {"speeds": bd.plot.speeds, "tensions": bd.plot.span_tensions}, PICTURES / "readme.png")
    contact = partial(bd.plot.contact_forces, pulley="driver")
    draw(bd.simulate(loaded_drive()), {"speeds": bd.plot.speeds, "contact": contact}, PICTURES / "two_pulley.png")
    tasks = Path(__file__).parents[1] / "tasks"
    pressed = bd.steady_state(bd.load(tasks / "press_roller.toml"))
    bd.plot.nip_pressure(pressed).figure.figure.savefig(PICTURES / "nip_pressure.png", dpi=110, bbox_inches="tight")
    calender = bd.steady_state(bd.load(tasks / "calender.toml"))
    with TemporaryDirectory() as folder:
        (picture,) = bd.plot.save_all(calender, folder, ["nip_pressure"])
        (PICTURES / "calender.png").write_bytes(picture.read_bytes())

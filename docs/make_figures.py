"""Draw docs/_static/two_pulley.png, the picture of README and documentation: the paper's drive under load."""

from pathlib import Path

import beltdyn as bd
from beltdyn.plot.style import new_figure, styled
from beltdyn.published import demo_text

PICTURE = Path(__file__).parent / "_static" / "two_pulley.png"


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
def draw(run: bd.Run, path: Path) -> None:
    """Draw the drive, its speeds and its normal contact force side by side.

    Parameters
    ----------
    run
        The run.
    path
        The PNG to write.
    """
    figure = new_figure((8.0, 6.8))
    panels = figure.subplot_mosaic([["drive", "drive"], ["speeds", "contact"]], height_ratios=(3, 2))
    bd.plot.configuration(run, ax=panels["drive"])
    bd.plot.speeds(run, ax=panels["speeds"])
    bd.plot.contact_forces(run, "driver", ax=panels["contact"])
    panels["contact"].set_xlabel("Belt from entry to exit [m]")
    figure.savefig(path, dpi=110)


if __name__ == "__main__":
    PICTURE.parent.mkdir(exist_ok=True)
    draw(bd.simulate(loaded_drive()), PICTURE)

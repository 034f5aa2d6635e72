"""Draw the pictures of docs/commands/designs.md: `python docs/scripts/studies_figures.py`, in some minutes."""

from importlib.resources import files
from pathlib import Path

import beltdyn as bd

PICTURES = Path(__file__).parents[1] / "_static" / "studies"
RESULTS = ["hub_load[alternator]", "slip_safety[alternator]", "tensioner_position", "efficiency"]
PRELOAD = {"path": "tensioner[1].preload", "values": "8..20 N m", "steps": 7}
TORQUE = {"path": "pulley[alternator].load[1].constant", "values": "2..12 N m", "steps": 6}
MORE = [
    {"path": "belt.ribs", "values": [4, 7]},
    {"path": "pulley[alternator].radius", "values": "26..30 mm", "steps": 2},
]


def main() -> None:
    drive = bd.load(str(files("beltdyn") / "examples" / "alternator_drive.toml"))
    ends = [PRELOAD | {"steps": 2}, TORQUE | {"steps": 2}, *MORE]
    studies = (
        bd.ParameterStudy(analysis="steady_state", results=RESULTS, number=[PRELOAD, TORQUE]),
        bd.ParameterStudy(analysis="steady_state", results=RESULTS, number=ends, sampling="one_at_a_time"),
        bd.ParameterStudy(analysis="steady_state", results=RESULTS, number=ends, sampling="saltelli", points=16),
    )
    for study in studies:
        bd.plot.save_all(bd.study(study, drive), PICTURES)


if __name__ == "__main__":
    main()

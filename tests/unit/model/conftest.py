"""Drives of every layout: open, crossed, flat with an idler on the back, serpentine."""

from collections.abc import Callable
from typing import Any

import pytest

from beltdyn.model import Drive

Circle = tuple[str, float, float, float, str]

OPEN: tuple[Circle, ...] = (("driver", 0.0, 0.0, 0.12, "inside"), ("driven", 0.6, 0.1, 0.07, "inside"))
CROSSED: tuple[Circle, ...] = (("driver", 0.0, 0.0, 0.12, "inside"), ("driven", 0.6, 0.0, 0.08, "outside"))
FLAT: tuple[Circle, ...] = (
    ("motor", 0.0, 0.0, 0.1, "inside"),
    ("idler", 0.25, -0.05, 0.04, "outside"),
    ("fan", 0.8, 0.0, 0.2, "inside"),
)
SERPENTINE: tuple[Circle, ...] = (
    ("crank", 0.0, 0.0, 0.08, "inside"),
    ("air conditioning", 0.22, -0.06, 0.06, "inside"),
    ("alternator", 0.26, 0.16, 0.03, "inside"),
    ("idler", 0.11, 0.16, 0.035, "outside"),
    ("power steering", 0.08, 0.33, 0.06, "inside"),
    ("water pump", -0.03, 0.17, 0.05, "outside"),
    ("tensioner", -0.17, 0.07, 0.035, "inside"),
)
LAYOUTS = {"open": OPEN, "crossed": CROSSED, "flat": FLAT, "serpentine": SERPENTINE}

MakeDrive = Callable[..., Drive]


@pytest.fixture(scope="session")
def make_drive() -> MakeDrive:
    """Make a drive of circles (name, x, y, radius, side); keywords go to the belt."""

    def make(
        layout: str | tuple[Circle, ...], *, contact: Any = None, tensioner: Any = (), **belt: float | bool | None
    ) -> Drive:
        circles = LAYOUTS[layout] if isinstance(layout, str) else layout
        section = {"width": 0.02, "thickness": 0.005, "density": 1100.0, "youngs_modulus": 5e8, "poissons_ratio": 0.3}
        given = {} if belt.keys() & {"length", "installed_tension"} else {"installed_tension": 400.0}
        return Drive(
            belt=section | {"bending_factor": 0.01, "crossed": layout == "crossed"} | given | belt,
            pulley=[
                {"name": name, "center": (x, y), "radius": radius, "side": side, "inertia": 0.01}
                for name, x, y, radius, side in circles
            ],
            contact={"friction": 0.5, "creep_rate_factor": 1e4, "friction_law": "force_slope"}
            | (contact or {"stiffness": 1e9}),
            tensioner=tensioner,
            simulation={"duration": 0.1, "output_interval": 1e-3},
        )

    return make

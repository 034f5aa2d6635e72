"""The dynamic cases of the paper's section 5, each with its published settings, and two more of the same kind."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from types import MappingProxyType
from typing import Any

from beltdyn.model import Drive, loads
from beltdyn.model.toml import example_text

RISE = MappingProxyType({"start": 0.05, "end": 0.6})
"""When speed and torque rise, s (Eqs. 28 and 29)."""


@dataclass(frozen=True, slots=True)
class Case:
    """A published case, as a list of them shows it.

    Attributes
    ----------
    build : callable
        Gives the drive; its arguments are what the paper varies.
    figures : str
        Where the paper shows it, or what it adds to the paper.
    description : str
        What it is, in one sentence.
    """

    build: Callable[..., Drive]
    figures: str
    description: str


def demo_text() -> str:
    """The drive file of the paper's two-pulley drive (Table 1, Eq. 28, 20 elements), TOML.

    It departs from the published settings in contact, which is integrated over the touching zone and never pulls, and
    has no shear.
    """
    return example_text("two_pulley")


def two_pulley(elements: int = 20, youngs_modulus: float = 1e8, creep_rate_factor: float = 1e5) -> Drive:
    """The two-pulley drive of Table 1 and Eq. 28, as published (Figs. 7-9).

    Parameters
    ----------
    elements
        Number of belt elements; the paper uses 20, 25 and 30.
    youngs_modulus
        Young's modulus, Pa; the paper uses 1e8 and, in Figs. 8 and 9, 1e9.
    creep_rate_factor
        Slope of the friction force over the slip velocity, kg/(m s); the paper uses 1e5 and, in Fig. 9, 1e4.

    Returns
    -------
    Drive
        Without load; the driver runs up to 12 rad/s in 0.55 s.
    """
    drive = loads(demo_text())
    return drive.replace(
        belt=drive.belt.replace(
            elements=elements, youngs_modulus=youngs_modulus, shear_correction=_rectangle(drive.belt.poissons_ratio)
        ),
        contact=drive.contact.replace(integration="fixed", normal_law="published", creep_rate_factor=creep_rate_factor),
        simulation=drive.simulation.replace(rtol=1e-3),
    )


def _rectangle(poissons_ratio: float) -> float:
    """Shear correction factor of a rectangle, which the paper names without a value."""
    return 10 * (1 + poissons_ratio) / (12 + 11 * poissons_ratio)


def loaded_two_pulley(creep_rate_factor: float = 1e4, points: int = 5, elements: int = 30) -> Drive:
    """The drive of the paper's force distributions (Eq. 29, Figs. 10-13).

    Parameters
    ----------
    creep_rate_factor
        Slope of the friction force over the slip velocity, kg/(m s); the paper uses 1e4 and 1e5.
    points
        Gauss points an element for the contact forces; the paper uses 5, 7 and 11.
    elements
        Number of belt elements; the paper uses 30.

    Returns
    -------
    Drive
        Under 45 N m, as printed with a jump at 0.05 s; the driver runs up to 120 rad/s in the time of Eq. 28.
    """
    drive = two_pulley(elements, 1e9, creep_rate_factor)
    driver, driven = drive.pulleys
    return drive.replace(
        belt=drive.belt.replace(length=1.2443, bending_factor=0.001),
        pulley=[
            driver.replace(speed={"kind": "ramp", "value": 120.0, **RISE}),
            driven.replace(torque={"kind": "cosine_ramp_published", "value": -45.0, **RISE}),
        ],
        contact=drive.contact.replace(quadrature_points=points),
    )


def unequal_pulleys(elements: int = 20) -> Drive:
    """The two-pulley drive with a driven pulley of 0.1218 m radius (Fig. 14); centers and belt stay.

    Parameters
    ----------
    elements
        Number of belt elements.

    Returns
    -------
    Drive
        Its belt is stretched by ten per cent.
    """
    drive = two_pulley(elements)
    driver, driven = drive.pulleys
    return drive.replace(pulley=[driver, driven.replace(radius=0.1218)])


def three_pulleys(elements: int = 30) -> Drive:
    """Three pulleys of different sizes, for the paper's remark that the model takes more than two.

    Driver and driven pulley are those of Fig. 14; the third, small and light, stands above them.  The belt is stretched
    by as much as that of the two-pulley drive, 0.28 %.  No figure of the paper shows such a drive.

    Parameters
    ----------
    elements
        Number of belt elements.  With 30 an element covers as much of the small pulley as one of 20 covers in Table 1.

    Returns
    -------
    Drive
        Without load; the driver runs up to 12 rad/s in 0.55 s.
    """
    drive = unequal_pulleys(elements)
    small = {"name": "small", "center": (0.0, 0.25), "radius": 0.065, "inertia": 0.02}
    return drive.replace(
        belt=drive.belt.replace(length=1.5868),
        pulley=[*drive.pulleys, small],
    )


def loaded_case_1(elements: int = 20, torque: float = 1.0) -> Drive:
    """The two-pulley drive of Table 1 under a moderate load, which the paper does not have.

    The load rises smoothly from 0.6 s, when the driver has its speed, to 1 s.  It is a quarter of what Euler's formula
    lets the belt carry, 2 T R (exp(mu pi) - 1) / (exp(mu pi) + 1) = 4.1 N m at the installed tension T of 26.6 N.
    Within the ramp of speed, the driven pulley alone takes 2.2 N m to be accelerated, and swings to nearly twice as
    much.

    Parameters
    ----------
    elements
        Number of belt elements.
    torque
        The load on the driven pulley, N m; it opposes the motion.

    Returns
    -------
    Drive
        It runs for 2 s.
    """
    drive = two_pulley(elements)
    driver, driven = drive.pulleys
    load = {"kind": "cosine_ramp", "start": 0.6, "end": 1.0, "value": -torque}
    return drive.replace(
        pulley=[driver, driven.replace(torque=load)], simulation=drive.simulation.replace(duration=2.0)
    )


def better(drive: Drive, elements: int | None = None, **simulation: Any) -> Drive:
    """The same drive with the settings that serve better than the published ones.

    Contact is integrated over the touching zone, never pulls, and the belt starts from equilibrium.

    Parameters
    ----------
    drive
        A published case.
    elements
        Number of belt elements, if another.
    **simulation
        Arguments of `Simulation` that differ.

    Returns
    -------
    Drive
    """
    return drive.replace(
        belt=drive.belt.replace(elements=elements or drive.elements),
        contact=drive.contact.replace(integration="zone", normal_law="no_pull"),
        simulation=drive.simulation.replace(**{"start": "equilibrium"} | simulation),
    )


CASES: Mapping[str, Case] = MappingProxyType(
    {
        "two_pulley": Case(two_pulley, "Figs. 7-9", "two equal pulleys, no load (Table 1, Eq. 28)"),
        "loaded_two_pulley": Case(loaded_two_pulley, "Figs. 10-13", "the same at 120 rad/s under 45 N m (Eq. 29)"),
        "unequal_pulleys": Case(unequal_pulleys, "Fig. 14", "two pulleys of different radii"),
        "three_pulleys": Case(three_pulleys, "in the paper's words only", "three pulleys of different radii"),
        "loaded_case_1": Case(loaded_case_1, "not in the paper", "two equal pulleys under a moderate load"),
    }
)
"""Name -> case; the belt released from its pulleys (Figs. 4 and 5) is in `validation.published.released_belt`."""

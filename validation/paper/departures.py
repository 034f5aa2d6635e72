"""Where the code departs from the printed text, in a sentence each; docs/deviations.md measures their effect."""

from dataclasses import dataclass
from types import MappingProxyType


@dataclass(frozen=True, slots=True)
class Departure:
    """A departure from the printed text, or a finding about it that bears on statements.

    Attributes
    ----------
    title : str
        What it is about.
    text : str
        What is printed, and what the code does.
    setting : str
        How to get the published behavior; empty where there is none, or none is needed.
    """

    title: str
    text: str
    setting: str = ""


DEPARTURES = MappingProxyType(
    {
        "integration-of-contact": Departure(
            "Integration of contact",
            "The paper integrates contact over whole elements. Better settings integrate it over the touching part of "
            "each.",
            'contact.integration = "fixed"',
        ),
        "start": Departure(
            "Start",
            "The paper lays the belt on its path at uniform stretch, and does not say where node 0 lies: here, where "
            "the belt leaves the driver. Better settings start from equilibrium.",
            'simulation.start = "laid"',
        ),
        "the-torque-of-eq-29": Departure(
            "The torque of Eq. 29",
            "As printed it jumps at 0.05 s. The runs of this page have it as printed.",
            'kind = "cosine_ramp_published"',
        ),
        "a-normal-force-that-never-pulls": Departure(
            "A normal force that never pulls",
            "Eq. 17 as printed pulls the belt back where it leaves fast. With better settings it does not.",
            'contact.normal_law = "published"',
        ),
        "nodal-shear": Departure(
            "Nodal shear",
            "The paper does not print how nodal values of sin γ follow from the gradients. Here ∂r/∂y is normalized.",
        ),
        "eq-11": Departure(
            "Eq. 11",
            "The factor of y is printed with a −1 too many. The term vanishes over the section.",
        ),
        "shear-correction": Departure(
            "Shear correction",
            "The paper names kₛ without a value. Here it is that of a rectangle.",
            "belt.shear_correction",
        ),
        "moments": Departure(
            "Moments",
            "The paper does not say on what a moment acts. Here it turns the section ∂r/∂y.",
        ),
        "tension-on-coarse-meshes": Departure(
            "Tension on coarse meshes",
            "Not a departure but a finding: a cubic of fixed length cannot follow line and arc without stretching "
            "(membrane locking).",
        ),
        "the-peaks-of-friction-belong-to-the-penalty": Departure(
            "The peaks of friction belong to the penalty",
            "Not a departure but a finding: they shrink as the stiffness of contact grows.",
        ),
    }
)
"""Name, which is that of its heading in docs/deviations.md -> departure."""

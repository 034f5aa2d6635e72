"""The paper's cases by name, with its published settings: laid start, fixed Gauss points, Eq. 17 as printed."""

from importlib.resources import files

from beltdyn.model import Drive, loads

__all__ = ["demo_text", "two_pulley"]


def demo_text() -> str:
    """The drive file of the paper's two-pulley drive (Table 1, Eq. 28, 20 elements), TOML.

    It departs from the published settings in contact, which is integrated over the touching zone and never pulls.
    """
    return files("beltdyn").joinpath("published", "two_pulley.toml").read_text(encoding="utf-8")


def two_pulley(elements: int = 20) -> Drive:
    """The two-pulley drive of Table 1 and Eq. 28, as published.

    Parameters
    ----------
    elements
        Number of belt elements; the paper uses 20, 25 and 30.

    Returns
    -------
    Drive
        Without load; the driver runs up to 12 rad/s in 0.55 s.
    """
    drive = loads(demo_text())
    return drive.replace(
        belt=drive.belt.replace(elements=elements),
        contact=drive.contact.replace(integration="fixed", normal_law="published"),
    )

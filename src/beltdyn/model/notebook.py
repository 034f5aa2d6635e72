"""A drive as a notebook shows it: its picture, its pulleys, its belt at rest, and what to know before a run."""

from functools import cache

import numpy as np
from jinja2 import Environment, PackageLoader

from beltdyn.model.advice import advise
from beltdyn.model.drive import Drive
from beltdyn.model.installation import install
from beltdyn.model.picture import picture


@cache
def templates() -> Environment:
    """Templates of the pages that notebooks show; text is escaped."""
    return Environment(loader=PackageLoader("beltdyn"), autoescape=True, trim_blocks=True, lstrip_blocks=True)


def drive_html(drive: Drive) -> str:
    """Show a drive as HTML.

    Parameters
    ----------
    drive : Drive

    Returns
    -------
    str
        A fragment that takes the notebook's fonts and colours.
    """
    installation = install(drive)
    template = templates().get_template("drive.html.jinja")
    return template.render(
        picture=picture(drive),
        drive=drive,
        radii=drive.radii,
        wraps=np.degrees(drive.path.wrap_angles),
        tension=installation.tension,
        warnings=advise(drive, installation),
    )

"""A drive and a result as a notebook shows them: picture, numbers, warnings."""

from functools import cache

import numpy as np
from jinja2 import Environment, PackageLoader

from beltdyn.model.advice import advise
from beltdyn.model.drive import Drive
from beltdyn.model.installation import install
from beltdyn.model.picture import picture
from beltdyn.results.recorded import runs_steadily
from beltdyn.results.result import Result
from beltdyn.results.sheet import sheet


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


def result_html(result: Result) -> str:
    """Show a result as HTML.

    Parameters
    ----------
    result : Result
        Of any analysis.

    Returns
    -------
    str
        A fragment that takes the notebook's fonts and colours.
    """
    return (
        templates()
        .get_template("result.html.jinja")
        .render(
            drive=result.drive,
            picture=picture(result.drive),
            kind="steady running" if runs_steadily(result.dataset) else result.kind,
            status=result.status,
            sheet=sheet(result).parts,
            warnings=result.warnings,
        )
    )

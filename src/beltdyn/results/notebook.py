"""A result as a notebook shows it: the picture of its drive, its sheet, and its warnings."""

from beltdyn.model.notebook import templates
from beltdyn.model.picture import picture
from beltdyn.results.recorded import runs_steadily
from beltdyn.results.result import Result
from beltdyn.results.sheet import sheet


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

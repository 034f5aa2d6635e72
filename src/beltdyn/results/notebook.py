"""A run as a notebook shows it: the picture of its drive, means of pulleys and spans, and its warnings."""

from beltdyn.model.notebook import templates
from beltdyn.model.picture import picture
from beltdyn.results.run import Run
from beltdyn.results.summary import summarize


def run_html(run: Run) -> str:
    """Show a run as HTML.

    Parameters
    ----------
    run : Run

    Returns
    -------
    str
        A fragment that takes the notebook's fonts and colours.
    """
    return (
        templates()
        .get_template("run.html.jinja")
        .render(
            drive=run.drive,
            picture=picture(run.drive),
            summary=summarize(run) if run.outputs else None,
            warnings=run.warnings,
        )
    )

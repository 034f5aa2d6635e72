"""Check a drive before any analysis: at rest, with what is probably not meant."""

from dataclasses import dataclass, field

from beltdyn.errors import ConvergenceError
from beltdyn.model import Drive, Installation, advise, install, unstable_balance
from beltdyn.show.notebook import picture, templates
from beltdyn.show.rest_sheet import rest_sheet
from beltdyn.show.sheet import Sheet, as_text
from beltdyn.solvers.progress import Report
from beltdyn.state.installation import bring_to_rest


@dataclass(frozen=True, repr=False)
class Check:
    """A drive at rest, and what is probably not meant in it; ``print`` shows all."""

    drive: Drive
    """The drive, with the belt length or the take-up that gives its installed tension."""
    installation: Installation
    """Tension, penetrations, hub loads and span frequencies at rest, of the equilibrium or, without one, estimated."""
    warnings: list[str]
    """What is probably not meant, by how much it matters, and remedies."""
    sheet: Sheet
    """Tables and facts for a reader."""
    failure: ConvergenceError | None = field(default=None)
    """Why there is no static equilibrium."""

    def __repr__(self) -> str:
        count = len(self.warnings)
        return (
            f'Check of "{self.drive.title}": {self.installation.tension:.4g} N at rest'
            f"{' (estimated)' * (self.failure is not None)}, {count or 'no'} warning{'s' * (count != 1)}"
        )

    def __str__(self) -> str:
        return "\n".join([as_text(self.sheet), *(f"warning: {warning}" for warning in self.warnings)])

    def _repr_html_(self) -> str:
        page = templates().get_template("result.html.jinja")
        shown = {"drive": self.drive, "picture": picture(self.drive), "sheet": self.sheet.parts}
        return page.render(**shown, kind="drive", status="at rest", warnings=self.warnings)


def check(drive: Drive, progress: Report | None = None) -> Check:
    """Bring a drive to rest, and look for what is probably not meant.

    Parameters
    ----------
    drive : Drive
        The drive.
    progress : callable, optional
        Called with a `Progress` before compilation and before the search.

    Returns
    -------
    Check
        Of closed-form estimates, without bending and weight, and with a `failure`, if there is no static equilibrium.

    Examples
    --------
    >>> checked = bd.check(drive)
    >>> round(checked.installation.tension), len(checked.warnings)  # N
    (27, 4)
    >>> checked.installation.hub_loads.shape
    (2, 2)
    """
    estimate = install(drive)
    try:
        rest = bring_to_rest(drive, progress)
    except ConvergenceError as error:
        return Check(drive, estimate, advise(drive, estimate), rest_sheet(drive, drive, estimate), error)
    unstable = [str(unstable_balance(rest.unstable))] if rest.unstable else []
    found = rest.installation
    return Check(rest.drive, found, [*unstable, *advise(drive, estimate)], rest_sheet(drive, rest.drive, found))

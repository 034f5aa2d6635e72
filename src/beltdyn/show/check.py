"""Check a drive before any analysis: at rest, with what is probably not meant."""

from dataclasses import dataclass, field, replace

from beltdyn.errors import ConvergenceError
from beltdyn.model import Drive, Installation, advise, estimate_at_rest, install, prepare, unstable_balance
from beltdyn.show.notebook import picture, templates
from beltdyn.show.rest_sheet import rest_sheet
from beltdyn.show.sheet import Sheet, as_text
from beltdyn.solvers.progress import Report
from beltdyn.state.installation import bring_to_rest, is_compiled


@dataclass(frozen=True, repr=False)
class Check:
    """A drive at rest, and what is probably not meant in it; ``print`` shows all."""

    drive: Drive
    """The drive, with the belt length or the take-up that gives its installed tension."""
    installation: Installation
    """Tension, penetrations, hub loads and span frequencies at rest."""
    warnings: list[str]
    """What is probably not meant, by how much it matters, and remedies."""
    sheet: Sheet
    """Tables and facts for a reader."""
    computed: bool = field(default=True)
    """Whether the installation is that of the computed equilibrium, and not of closed forms."""
    failure: ConvergenceError | None = field(default=None)
    """Why there is no static equilibrium, if it was sought."""

    def __repr__(self) -> str:
        count = len(self.warnings)
        return (
            f'Check of "{self.drive.title}": {self.installation.tension:.4g} N at rest'
            f"{' (closed form)' * (not self.computed)}, {count or 'no'} warning{'s' * (count != 1)}"
        )

    def __str__(self) -> str:
        return "\n".join([as_text(self.sheet), *(f"warning: {warning}" for warning in self.warnings)])

    def _repr_html_(self) -> str:
        page = templates().get_template("result.html.jinja")
        shown = {"drive": self.drive, "picture": picture(self.drive), "sheet": self.sheet.parts}
        return page.render(**shown, kind="drive", status="at rest", warnings=self.warnings)


def check(drive: Drive, progress: Report | None = None, *, equilibrium: bool | None = None) -> Check:
    """Bring a drive to rest, and look for what is probably not meant.

    Closed forms need no compilation of kernels. Their tensions, hub loads and span frequencies are within 1 % of the
    computed equilibrium on meshes that resolve the tension; see `beltdyn.model.estimate_at_rest`.

    Parameters
    ----------
    drive : Drive
        The drive.
    progress : callable, optional
        Called with a `Progress` before compilation and before the search.
    equilibrium : bool, optional
        Whether to compute the static equilibrium; by default where its kernels are compiled. Belts with teeth, supports
        or goods are judged by closed forms.

    Returns
    -------
    Check
        With a `failure`, and of closed forms, if there is no static equilibrium.

    Examples
    --------
    >>> checked = bd.check(drive)
    >>> round(checked.installation.tension), len(checked.warnings)  # N
    (27, 4)
    >>> checked.installation.hub_loads.shape
    (2, 2)
    """
    told = advise(drive, install(drive))
    if not drive.stays_at_rest and (equilibrium or (equilibrium is None and is_compiled(drive))):
        try:
            rest = bring_to_rest(drive, progress)
        except ConvergenceError as error:
            return replace(_estimated(drive, told), failure=error)
        unstable = [str(unstable_balance(rest.unstable))] if rest.unstable else []
        found = rest.installation
        return Check(rest.drive, found, [*unstable, *told], rest_sheet(drive, rest.drive, found))
    return _estimated(drive, told)


def _estimated(drive: Drive, told: list[str]) -> Check:
    """A drive at rest by closed forms."""
    prepared, found = estimate_at_rest(prepare(drive))
    sheet = rest_sheet(drive, prepared.drive, found, computed=False)
    return Check(prepared.drive, found, told, sheet, computed=False)

"""`beltdyn app`."""

from pathlib import Path
from typing import Annotated

from cyclopts import Parameter
from cyclopts.validators import Number

from beltdyn.cli.console import show as write


def app(
    file: Path | None = None,
    /,
    *,
    port: Annotated[int, Parameter(validator=Number(gte=0, lte=65535))] = 0,
    show: bool = True,
) -> None:
    """Edit and simulate a drive in the browser.

    The page is served on this machine only, at a secret address, and needs no network. It reads and writes drive files
    only in the folder of the given file, by default the working directory. Ctrl-C ends it.

    Parameters
    ----------
    file
        The drive file to open, TOML.
    port
        The port; by default any free one.
    show
        Open the browser; --no-show only prints the address.
    """
    from beltdyn.errors import ModelError

    try:
        from beltdyn.app.server import serve
    except ModuleNotFoundError as error:
        if error.name is None or error.name.startswith("beltdyn"):
            raise
        raise ModelError(
            f"the page needs {error.name}, which is not installed. Install beltdyn with its extra beltdyn[app]."
        ) from None
    from beltdyn.app.computing import Asked, Calculator
    from beltdyn.app.workspace import Folder, Workspace

    folder = Folder(Path() if file is None else file.parent)
    if file is not None:
        folder.read(file.name)  # an unreadable file is reported here
    calculator = Calculator()
    workspace = Workspace(folder, None if file is None else file.name, calculator)

    def begin(address: str) -> None:
        write(f"The page is at {address}\nCtrl-C ends it.")
        calculator.look_ahead(Asked("rest", "", workspace.usual_drive, folder.root))

    serve(workspace, port, show, begin)

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
    """Lay out and run a drive on a page in the browser.

    The page is served to this machine alone, at an address that only this command knows, and works without a network.
    It reads and writes drive files in the folder of the given file, by default in the working directory, and nowhere
    else. Ctrl-C ends it.

    Parameters
    ----------
    file
        The drive file to begin with, TOML.
    port
        The port; by default one that is free.
    show
        Open the browser; with --no-show only the address is written.
    """
    from beltdyn.errors import ModelError

    try:
        from beltdyn.app.server import serve
    except ModuleNotFoundError as error:
        if error.name is None or error.name.startswith("beltdyn"):
            raise
        raise ModelError(
            f'{error.name} is not installed, which the page needs. Install it: pip install "beltdyn[app]"'
        ) from None
    from beltdyn.app.calculator import Calculator
    from beltdyn.app.computing import Asked
    from beltdyn.app.folder import Folder
    from beltdyn.app.workspace import Workspace

    folder = Folder(Path() if file is None else file.parent)
    if file is not None:
        folder.read(file.name)  # what cannot be read is told here
    calculator = Calculator()
    workspace = Workspace(folder, None if file is None else file.name, calculator)

    def begin(address: str) -> None:
        write(f"The page is at {address}\nCtrl-C ends it.")
        calculator.look_ahead(Asked("rest", "", workspace.usual_drive, folder.root))

    serve(workspace, port, show, begin)

"""Drives to TOML."""

from typing import TYPE_CHECKING

import tomli_w

if TYPE_CHECKING:
    from beltdyn.model.drive import Drive


def dumps(drive: "Drive", installed_tension: float | None = None, with_length: bool = True) -> str:
    """Write a drive as TOML, in SI units and with every default spelled out.

    Parameters
    ----------
    drive : Drive
    installed_tension : float, optional
        Tension at rest to ask for, N.
    with_length : bool
        Write the length of the belt, also where a tension is asked for.

    Returns
    -------
    str
        A text from which `loads` makes the same drive.

    Examples
    --------
    >>> bd.loads(bd.dumps(drive)) == drive
    True
    """
    data = drive.model_dump(mode="json", by_alias=True, exclude_none=True)
    if installed_tension is not None:
        data["belt"]["installed_tension"] = installed_tension
        if not with_length:
            del data["belt"]["length"]
    return tomli_w.dumps(data, multiline_strings=False)

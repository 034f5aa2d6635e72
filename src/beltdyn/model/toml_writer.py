"""Drives to TOML."""

import tomli_w

from beltdyn.model.drive import Drive


def dumps(drive: Drive) -> str:
    """Write a drive as TOML, in SI units and with every default spelled out.

    Parameters
    ----------
    drive : Drive
        The drive. A tension that was asked for is asked for again, unless the length for it was found in a run.

    Returns
    -------
    str
        A text from which `loads` makes the same drive.

    Examples
    --------
    >>> bd.loads(bd.dumps(drive)) == drive
    True
    """
    return tomli_w.dumps(drive.data, multiline_strings=False)

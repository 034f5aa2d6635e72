"""Drives to TOML."""

import tomli_w

from beltdyn.model.drive import Drive


def dumps(drive: Drive) -> str:
    """Write a drive as TOML, in SI units and with every default spelled out.

    Parameters
    ----------
    drive : Drive
        The drive: what is given is written. That of a run has the length, or the take-up, that was found for it.

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

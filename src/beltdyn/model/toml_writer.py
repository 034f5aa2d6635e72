"""Drives to TOML."""

from typing import TYPE_CHECKING

import tomli_w

if TYPE_CHECKING:
    from beltdyn.model.drive import Drive


def dumps(drive: "Drive") -> str:
    """Write a drive as TOML, in SI units and with every default spelled out.

    Parameters
    ----------
    drive : Drive

    Returns
    -------
    str
        A text from which `loads` makes the same drive.

    Examples
    --------
    >>> bd.loads(bd.dumps(drive)) == drive
    True
    """
    return tomli_w.dumps(drive.model_dump(mode="json", by_alias=True, exclude_none=True), multiline_strings=False)

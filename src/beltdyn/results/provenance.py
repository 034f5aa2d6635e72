"""Where a result comes from: the drive, the versions and the hour."""

import platform
from datetime import UTC, datetime
from functools import cache
from importlib.metadata import version

from beltdyn.analyses import RUN
from beltdyn.results.schema import FORMAT

_PACKAGES = ("beltdyn", "numba", "numpy", "scipy")


def provenance(drive_text: str, title: str, kind: str = RUN) -> dict[str, str]:
    """Global attributes that are known before anything is computed.

    Parameters
    ----------
    drive_text : str
        The drive file's text.
    title : str
        What the dataset is, in a few words.
    kind : str
        Name of the analysis; "run" where results grow over time.

    Returns
    -------
    dict
        ``title``, ``kind``, ``drive``, ``format`` (version of the result file), ``beltdyn_version``, ``numba_version``,
        ``numpy_version``, ``scipy_version``, ``python_version`` and ``created`` (ISO 8601, UTC).
    """
    return {
        "title": title,
        "kind": kind,
        "drive": drive_text,
        "format": ".".join(map(str, FORMAT)),
        **_versions(),
        "python_version": platform.python_version(),
        "created": datetime.now(UTC).isoformat(timespec="seconds"),
    }


@cache
def _versions() -> dict[str, str]:
    """Of the packages that results depend on; finding them takes milliseconds."""
    return {f"{package}_version": version(package) for package in _PACKAGES}

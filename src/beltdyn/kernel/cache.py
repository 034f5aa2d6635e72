"""The folder of the compiled kernels, which cannot go stale.

Numba's own cache watches the file of the compiled function only.  A kernel that calls a law from another file would
keep the old physics after that law was edited.  Here the cache lives in a folder named by a hash of every source
file that takes part in compiled code, so that an edit anywhere in them starts an empty cache.
"""

import atexit
import hashlib
import os
import shutil
import tempfile
from functools import cache
from pathlib import Path

import platformdirs

from beltdyn.kernel.version import compiles_quickly

PACKAGE = Path(__file__).parents[1]

CACHE_VARIABLE = "BELTDYN_CACHE_DIR"
"""Environment variable that moves the kernel cache (default: the user's cache folder)."""


@cache
def kernel_cache() -> Path:
    """Folder of the compiled kernels of exactly these sources, made if need be.

    Returns
    -------
    Path
        Below ``$BELTDYN_CACHE_DIR`` or the user's cache folder; where neither can be written a temporary folder, which
        is gone at the end.
    """
    chosen = os.environ.get(CACHE_VARIABLE) or platformdirs.user_cache_path("beltdyn")
    folder = Path(chosen) / (source_hash(PACKAGE) + ("" if compiles_quickly() else "-plain"))
    try:
        folder.mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryFile(dir=folder):
            return folder
    except OSError:
        temporary = tempfile.mkdtemp(prefix="beltdyn-")
        atexit.register(shutil.rmtree, temporary, ignore_errors=True)
        return Path(temporary)


def source_hash(package: Path) -> str:
    """Hash of all sources below a folder that take part in compiled code, that is, that name this package.

    Parameters
    ----------
    package
        The folder to search for Python files.

    Returns
    -------
    str
        Sixteen hexadecimal digits.
    """
    digest = hashlib.sha256()
    for path in sorted(package.rglob("*.py")):
        source = path.read_bytes()
        if b"beltdyn.kernel" in source:
            digest.update(path.relative_to(package).as_posix().encode())
            digest.update(source)
    return digest.hexdigest()[:16]

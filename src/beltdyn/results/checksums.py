"""Checksums of every page of a result file, behind its HDF5 contents, where other readers do not look.

They cover all that HDF5 reads: values, attributes, names, coordinates, and how these are found.  While a file grows,
pages are changed in place; then the checksums before the change count as well, so that a file whose writer was killed
is one or the other, page by page.  Of two sets of checksums in a file the one with the higher number counts.

    magic | number | place | end | pages | earlier | owner | checksum of all of this | pages | earlier | owner
"""

import struct
import time
import zlib
from collections.abc import Iterator, Mapping
from functools import lru_cache
from itertools import pairwise
from pathlib import Path
from typing import BinaryIO, NamedTuple

import numpy as np
from numpy.typing import NDArray

from beltdyn.parts.text_file import open_file

PAGE = 4096
"""Bytes that have a checksum; the system writes a page as a whole, or not at all."""

MARK = "checksums of its pages are behind its end"
"""HDF5 comment of the root of a file that must have them; copies made by other programs are without it."""

_MAGIC = b"\x89beltdyn-pages\r\n"
_HEAD = struct.Struct("<16s6QI")
_EARLIER = np.dtype([("page", "<u8"), ("sum", "<u4")])
_SEARCHED = 1 << 20
"""Bytes that are searched at a time."""
_ATTEMPTS, _PAUSE = 10, 0.02
"""How often, and after how long (s), a file is read again that does not match: it may be written just then."""


class Checksums(NamedTuple):
    """Checksums of the pages of a file."""

    number: int
    """How many sets were written before."""
    place: int
    """Where this set begins."""
    end: int
    """Bytes that are covered."""
    pages: NDArray[np.uint32]
    earlier: Mapping[int, int]
    """Page -> the checksum before it was changed in place."""
    owner: str = ""
    """The file that a writer has locked while the results grow."""

    @property
    def size(self) -> int:
        """Bytes that this set takes."""
        own = len(self.owner.encode(errors="surrogateescape"))
        return _HEAD.size + self.pages.nbytes + len(self.earlier) * _EARLIER.itemsize + own

    def to_bytes(self) -> bytes:
        """What stands at the place."""
        earlier = np.array(list(self.earlier.items()), dtype=_EARLIER)
        owner = self.owner.encode(errors="surrogateescape")
        body = b"".join([self.pages.astype("<u4").tobytes(), earlier.tobytes(), owner])
        counts = self.number, self.place, self.end, len(self.pages), len(earlier), len(owner)
        head = _HEAD.pack(_MAGIC, *counts, 0)
        return _HEAD.pack(_MAGIC, *counts, zlib.crc32(body, zlib.crc32(head))) + body

    def match(self, page: int, data: bytes | memoryview) -> bool:
        """Whether a page is as it was written; of the last one what lies before the end."""
        found = zlib.crc32(data)
        return found == self.pages[page] or found == self.earlier.get(page)


def page_count(end: int) -> int:
    """Number of pages up to an end."""
    return -(-end // PAGE)


def find_checksums(file: BinaryIO) -> Checksums | None:
    """The checksums that count in a file."""
    size = file.seek(0, 2)
    last = next(_all_between(file, 0, size), None)
    if last is None:
        return None
    return max([last, *_all_between(file, last.end, last.place)], key=lambda one: one.number)


def _all_between(file: BinaryIO, start: int, stop: int) -> Iterator[Checksums]:
    """The sets that begin between two places, from the last one on."""
    while stop > start:
        first = max(start, stop - _SEARCHED)
        file.seek(first)
        data = file.read(stop - first + len(_MAGIC) - 1)
        place = data.rfind(_MAGIC)
        while place >= 0:
            found = _read(file, first + place)
            if found is not None:
                yield found
            place = data.rfind(_MAGIC, 0, place + len(_MAGIC) - 1)
        stop = first


def _read(file: BinaryIO, place: int) -> Checksums | None:
    """The set at a place, if it is whole."""
    file.seek(place)
    head = file.read(_HEAD.size)
    if len(head) < _HEAD.size:
        return None
    _, number, own_place, end, pages, earlier, owner, checksum = _HEAD.unpack(head)
    if own_place != place or end > place or pages != page_count(end) or earlier > pages or owner > PAGE:
        return None
    sizes = np.cumsum([0, 4 * pages, _EARLIER.itemsize * earlier, owner]).tolist()
    body = file.read(sizes[-1])
    if len(body) < sizes[-1] or zlib.crc32(body, zlib.crc32(head[:-4] + bytes(4))) != checksum:
        return None
    parts = [body[first:last] for first, last in pairwise(sizes)]
    before = {int(page): int(one) for page, one in np.frombuffer(parts[1], _EARLIER)}
    return Checksums(
        number, place, end, np.frombuffer(parts[0], "<u4"), before, parts[2].decode(errors="surrogateescape")
    )


class DamageError(ValueError):
    """A file is not as it was written."""


def verify(path: Path) -> bool:
    """Make sure that a file is as it was written."""
    status = path.stat()
    return _verify(path, (status.st_dev, status.st_ino, status.st_mtime_ns, status.st_size))


@lru_cache(maxsize=64)
def _verify(path: Path, _stamp: tuple[int, ...]) -> bool:
    with open_file(path) as file:
        for attempt in range(_ATTEMPTS):
            found = find_checksums(file)
            wrong = [] if found is None else list(_wrong_pages(file, found))
            if found is not None and not wrong:
                return True
            if not attempt and found is None and _is_quiet(path, _stamp):
                return False
            time.sleep(_PAUSE)
    if found is None:
        return False
    places = PAGE * np.array([wrong[0], wrong[-1] + 1])
    more = f"{len(wrong)} pages between bytes" if wrong[1:] else "the page of bytes"
    raise DamageError(
        f"it is damaged: {more} {places[0]:,} to {min(places[1], found.end):,} differ from what was written"
    )


def _is_quiet(path: Path, stamp: tuple[int, ...]) -> bool:
    """Whether nobody has written to a file since its stamp was taken, and a little while before."""
    status = path.stat()
    return status.st_mtime_ns == stamp[2] and time.time_ns() - stamp[2] > 1e9 * _ATTEMPTS * _PAUSE


def _wrong_pages(file: BinaryIO, checksums: Checksums) -> Iterator[int]:
    """Numbers of the pages that are not as they were written."""
    many = _SEARCHED // PAGE
    file.seek(0)
    for first in range(0, len(checksums.pages), many):
        data = memoryview(file.read(min(_SEARCHED, checksums.end - first * PAGE)))
        for page in range(first, min(first + many, len(checksums.pages))):
            start = (page - first) * PAGE
            if not checksums.match(page, data[start : start + PAGE]):
                yield page

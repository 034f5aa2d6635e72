"""A file that is changed as a whole or not at all, whatever the disk says.

HDF5 writes through this object into memory.  `StagedFile.commit` then writes what is new behind the old end of the
file, which may fail without harm, checksums behind it, and last the few bytes that change before it, which need no more
space.  HDF5 itself never meets a full disk: it would leave a file that cannot be read, and crash.

    contents | reserve | checksums        while it grows
    contents | checksums                  at the end

Checksums of every page of a result file, behind its HDF5 contents, where other readers do not look.

They cover all that HDF5 reads: values, attributes, names, coordinates, and how these are found.  While a file grows,
pages are changed in place; then the checksums before the change count as well, so that a file whose writer was killed
is one or the other, page by page.  Of two sets of checksums in a file the one with the higher number counts.

    magic | number | place | end | pages | earlier | owner | checksum of all of this | pages | earlier | owner
"""

import io
import os
import struct
import time
import zlib
from collections.abc import Iterator, Mapping
from contextlib import contextmanager, suppress
from functools import lru_cache
from itertools import pairwise
from pathlib import Path
from types import TracebackType
from typing import BinaryIO, Literal, NamedTuple, Self

import h5py
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


RESERVE = 1 << 16
"""Bytes that a growing file holds behind its contents, so that its end can be recorded on a full disk."""

_BLOCK_BYTES = 16384
"""Bytes that are staged together: a multiple of `PAGE`, so that the checksum of a page needs one block only."""


class StagedFile:
    """What h5py reads and writes in place of a file."""

    def __init__(self, path: Path, checksums: Checksums | None = None) -> None:
        self._file = path.open("r+b", buffering=0)
        self._length = os.fstat(self._file.fileno()).st_size
        self.checksums = checksums or find_checksums(self._file)
        self._blocks: dict[int, bytearray] = {}
        self._changed: set[int] = set()
        self._end = self.checksums.end if self.checksums else self._length
        self._place = 0

    def __enter__(self) -> Self:
        """Begin; the file is closed at the end, and changes that were not committed are dropped."""
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()

    def close(self) -> None:
        """Close the file, and drop what was not committed."""
        self._file.close()

    def identity(self) -> tuple[int, int]:
        """What tells the open file from any other."""
        return identity(os.fstat(self._file.fileno()))

    def seek(self, offset: int, whence: int = io.SEEK_SET) -> int:
        """Move to a place from the start, from where it is, or from the end."""
        self._place = offset + (0, self._place, self._end)[whence]
        return self._place

    def tell(self) -> int:
        """Place in the file."""
        return self._place

    def read(self, size: int) -> bytes:
        """Bytes at the place."""
        buffer = bytearray(size)
        return bytes(buffer[: self.readinto(memoryview(buffer))])

    def readinto(self, buffer: memoryview) -> int:
        """Fill a buffer with what was staged, or else with what the file holds."""
        buffer = memoryview(buffer).cast("B")  # h5py gives a view of its own kind
        count = max(min(len(buffer), self._end - self._place), 0)
        for place, start, stop in _pieces(self._place, count):
            target = buffer[place + start - self._place : place + stop - self._place]
            target[:] = self._block(place)[start:stop]
        self._place += count
        return count

    def write(self, data: memoryview) -> int:
        """Stage bytes at the place."""
        data = memoryview(data).cast("B")
        for place, start, stop in _pieces(self._place, len(data)):
            piece = data[place + start - self._place : place + stop - self._place]
            if stop - start == _BLOCK_BYTES:
                self._blocks[place] = bytearray(piece)
            else:
                self._block(place)[start:stop] = piece
            self._changed.add(place)
        self._place += len(data)
        self._end = max(self._end, self._place)
        return len(data)

    def truncate(self, size: int) -> int:
        """Stage a new end."""
        self._end = size
        return size

    def flush(self) -> None:
        """Keep waiting: `commit` writes."""

    def commit(self, reserve: int = RESERVE, owner: str = "") -> None:
        """Write what was staged, and checksums."""
        old, sums = self._length, self._checksums(reserve, owner)
        runs = [*self._changed_runs(sums.end), (sums.place, sums.to_bytes())]
        before = [(place, data[: old - place]) for place, data in reversed(runs) if place < old]
        behind = [(max(place, old), data[max(old - place, 0) :]) for place, data in runs if place + len(data) > old]
        as_it_was = [(place, self._stored(place, len(data))) for place, data in before]
        try:
            _write_all(self._file, _without_gaps(behind, old))
            _write_all(self._file, before)
        except OSError:
            with suppress(OSError):
                _write_all(self._file, as_it_was)
            with suppress(OSError):
                self._file.truncate(old)
            raise
        self._file.truncate(sums.place + sums.size)
        self.checksums = sums._replace(earlier={})

    def _checksums(self, reserve: int, owner: str) -> Checksums:
        """Checksums of what was staged, in a place where they do not overwrite those before."""
        known, old = self.checksums, self._length
        end = max(self._end, known.end) if known else self._end
        pages = np.zeros(page_count(end), dtype=np.uint32)
        kept = known.end // PAGE if known else 0
        if known:
            pages[:kept] = known.pages[:kept]
        changed = {page for place in self._changed for page in range(place // PAGE, (place + _BLOCK_BYTES) // PAGE)}
        earlier = {}
        for page in sorted({*changed, *range(kept, len(pages))}):
            place, size = page * PAGE, min(PAGE, end - page * PAGE)
            if size > 0:
                block = place - place % _BLOCK_BYTES
                data = memoryview(self._block(block))[place - block : place - block + size]
                pages[page] = zlib.crc32(data)
                if known and not known.earlier and page < kept:
                    earlier[page] = int(known.pages[page])
                elif place < old:
                    was = self._stored(place, min(size, old - place))
                    earlier[page] = zlib.crc32(data[len(was) :], zlib.crc32(was))
        earlier = {page: one for page, one in earlier.items() if one != pages[page]}
        sums = Checksums(known.number + 1 if known else 0, 0, end, pages, earlier, owner)
        place = end + (reserve + sums.size if reserve else 0)
        if known and place + sums.size > known.place:
            place = max(place, old)
        return sums._replace(place=place)

    def _changed_runs(self, end: int) -> list[tuple[int, bytes]]:
        """What was written, in runs without a gap, up to an end."""
        runs: list[tuple[int, bytearray]] = []
        for place in sorted(self._changed):
            if runs and runs[-1][0] + len(runs[-1][1]) == place:
                runs[-1][1].extend(self._blocks[place])
            else:
                runs.append((place, self._blocks[place].copy()))
        return [(place, bytes(data[: end - place])) for place, data in runs if place < end]

    def _block(self, place: int) -> bytearray:
        """A block as it is now."""
        if place not in self._blocks:
            data = self._stored(place, _BLOCK_BYTES)
            if self.checksums:
                _require_same(self.checksums, place, data)
            self._blocks[place] = bytearray(data.ljust(_BLOCK_BYTES, b"\0"))
        return self._blocks[place]

    def _stored(self, place: int, size: int) -> bytes:
        """What the file holds."""
        if place >= self._length:
            return b""
        self._file.seek(place)
        data = b""
        while len(data) < size and (more := self._file.read(size - len(data))):
            data += more
        return data


def _require_same(checksums: Checksums, place: int, data: bytes) -> None:
    for first in range(place, min(place + len(data), checksums.end), PAGE):
        last = min(first + PAGE, checksums.end)
        if not checksums.match(first // PAGE, data[first - place : last - place]):
            raise OSError(f"it is damaged: bytes {first:,} to {last:,} differ from what was written")


@contextmanager
def staged_hdf5(path: Path, mode: Literal["w", "r+"]) -> Iterator[h5py.File]:
    """Change an HDF5 file as a whole or not at all."""
    with StagedFile(path) as staged:
        with h5py.File(staged, mode) as file:
            yield file
            mark(file)
        staged.commit(reserve=0)


def mark(file: h5py.File) -> None:
    """Note in a file that it has checksums."""
    file["/"].id.set_comment(b".", MARK.encode())


def is_marked(file: h5py.File) -> bool:
    """Whether a file says that it has checksums."""
    return bool(file["/"].id.get_comment(b".") == MARK.encode())


def identity(status: os.stat_result) -> tuple[int, int]:
    """What tells a file from any other, whatever its name."""
    return status.st_dev, status.st_ino


def _pieces(place: int, count: int) -> Iterator[tuple[int, int, int]]:
    """Blocks that a stretch of bytes lies in: the place of each, and where in it the stretch begins and ends."""
    for block in range(place - place % _BLOCK_BYTES, place + count, _BLOCK_BYTES):
        yield block, max(place - block, 0), min(place + count - block, _BLOCK_BYTES)


def _without_gaps(pieces: list[tuple[int, bytes]], start: int) -> list[tuple[int, bytes]]:
    """Pieces in their order with zeros between them, from a place on: a disk that is full says so at once."""
    filled = []
    for place, data in pieces:
        filled += [(start, bytes(place - start))] * (place > start) + [(place, data)]
        start = max(start, place + len(data))
    return filled


def _write_all(file: io.FileIO, pieces: list[tuple[int, bytes]]) -> None:
    """Write at places, to the last byte: on a full disk the system may take a part before it refuses."""
    for place, data in pieces:
        file.seek(place)
        left = memoryview(data)
        while left:
            left = left[file.write(left) or 0 :]

"""Objects as bytes: they come back to the bit, and bytes of others make nothing that is not listed."""

import hashlib
import json
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import array_shapes, arrays, scalar_dtypes

from beltdyn.arrays import blank, record, records
from beltdyn.errors import ModelError
from beltdyn.kernel import user_key
from beltdyn.kernel.user_key import signature
from beltdyn.model import Drive
from beltdyn.transient.packing import ForeignError, Packing


class Pair(NamedTuple):
    one: Any
    other: Any


@dataclass(frozen=True)
class Frozen:
    value: Any


class Unknown:
    """What nobody has listed."""


PACKING = Packing((Pair, Frozen))
DIGEST = hashlib.sha256().digest_size
ROW = record(number="f8", whole="i8", place="(2,)f8", flag="?")


def again(value: Any) -> Any:
    return PACKING.unpack(PACKING.pack(value))


def sealed(tree: Any, arrays: bytes = b"") -> bytes:
    """Bytes of a tree, with a signature and a checksum that match."""
    text = tree if isinstance(tree, bytes) else json.dumps(tree).encode()
    content = len(text).to_bytes(8, "little") + text + arrays
    signed = signature(content) + content
    return hashlib.sha256(signed).digest() + signed


NUMBERS = scalar_dtypes().filter(lambda dtype: dtype.kind in "biufc" and dtype.itemsize <= 16 and dtype.isnative)


@given(arrays(NUMBERS, array_shapes(min_dims=0, min_side=0)), st.booleans())
def test_arrays_come_back_to_the_bit(array: Any, turned: bool) -> None:
    array = array.T if turned else array
    found = again(array)
    assert found.dtype == array.dtype
    assert found.shape == array.shape
    assert found.tobytes() == array.tobytes()
    assert found.flags.writeable
    assert found.flags.f_contiguous == array.flags.f_contiguous


@given(st.recursive(st.none() | st.booleans() | st.integers() | st.floats() | st.text(), st.lists))
def test_plain_values_come_back(value: Any) -> None:
    assert repr(again(value)) == repr(value)
    assert repr(again({"name": (value, 1.0 + 2.0j)})) == repr({"name": (value, 1.0 + 2.0j)})


def test_rows_are_those_of_kernels() -> None:
    import numba

    table, row = records(ROW, number=[1.0, 2.0], place=np.ones((2, 2))), blank(ROW)
    row.whole = 7
    for value in (table, row):
        found = again(value)
        assert numba.typeof(found) == numba.typeof(value)
        assert np.all(np.asarray(found) == np.asarray(value))


def test_one_object_stays_one() -> None:
    array, inner = np.zeros(2), [1]
    found = again(Pair(Frozen(array), Pair([array, inner], inner)))
    assert found.one.value is found.other.one[0]
    assert found.other.one[1] is found.other.other
    assert isinstance(found.one, Frozen)


def test_drives_are_kept_as_text(drive: Drive) -> None:
    assert again(drive) == drive


@pytest.mark.parametrize("value", [Unknown(), Unknown, np.array([None]), np.array(["text"]), {1, 2}, b"bytes", print])
def test_what_is_not_listed_is_not_written(value: Any) -> None:
    with pytest.raises(ModelError, match="not among"):
        PACKING.pack([value])


TREES: list[Any] = [
    {"is": "Unknown", "of": {}},
    {"is": "os.system", "of": ["echo taken"]},
    {"is": "Pair", "of": [1]},
    {"is": "Pair", "of": {"one": 1}},
    {"is": "Frozen", "of": [1]},
    {"is": "drive", "of": "belt = 3"},
    {"is": "drive", "of": 3},
    {"is": "again", "of": 0},
    {"is": "again", "of": 10**30},
    {"is": "array", "type": "|O", "shape": [1], "order": "C"},
    {"is": "array", "type": "<f8", "shape": [10**12], "order": "C"},
    {"is": "array", "type": "<f8", "shape": [-1], "order": "C"},
    {"is": "array", "type": "<f8", "shape": [1], "order": "Q"},
    {"is": "row", "type": {"names": ["a"], "formats": ["<f8"], "offsets": [-8], "itemsize": 8, "aligned": False}},
    {"is": "dict", "of": [[{"is": "list", "of": []}, 1]]},
    {"is": "list"},
    {},
    [1],
    b"[" * 100_000,
    b'{"is"',
    b"\xff",
]


@pytest.mark.parametrize("tree", TREES, ids=range(len(TREES)))
def test_trees_that_nobody_writes_make_nothing(tree: Any) -> None:
    with pytest.raises(ModelError):
        PACKING.unpack(sealed(tree, bytes(64)))


def test_bytes_of_others_make_nothing(monkeypatch: pytest.MonkeyPatch) -> None:
    """Their checksum is right; a kernel would follow their numbers beyond its arrays, or to an address."""
    data = PACKING.pack([1.0, np.zeros(3)])
    content = data[2 * DIGEST :]
    for forged in (bytes(DIGEST), hashlib.sha256(content).digest()):
        with pytest.raises(ForeignError, match="not signed with the key"):
            PACKING.unpack(hashlib.sha256(forged + content).digest() + forged + content)
    monkeypatch.setattr(user_key, "_key", lambda: bytes(DIGEST))
    with pytest.raises(ForeignError, match="not signed with the key"):
        PACKING.unpack(data)


@pytest.mark.parametrize(
    "change", [lambda data: b"", lambda data: data[:-1], lambda data: data + b"0", lambda data: data[40:]]
)
def test_cut_bytes_are_damaged(change: Callable[[bytes], bytes]) -> None:
    with pytest.raises(ModelError, match="checksum"):
        PACKING.unpack(change(PACKING.pack([1.0, np.zeros(3)])))


def test_no_bit_changes_unseen() -> None:
    data = PACKING.pack(Pair(np.arange(3.0), "text"))
    for bit in range(8 * len(data)):
        changed = bytearray(data)
        changed[bit // 8] ^= 1 << bit % 8
        with pytest.raises(ModelError, match="checksum"):
            PACKING.unpack(bytes(changed))

"""Objects as bytes and back: JSON, arrays behind it, and before both a checksum and a signature.

What is read goes into arrays of kernels, which check no bounds, and into addresses that they call.  So it counts only
if it was written with the key of the same user.
"""

import hashlib
import json
import re
from collections.abc import Iterable
from math import prod
from typing import Any, Literal

import numpy as np

from beltdyn.errors import ModelError
from beltdyn.kernel.user_key import SIGNATURE_SIZE, is_signed, key_file, signature
from beltdyn.model import Drive, Prepared, prepare
from beltdyn.model.drive import drive_of_text

_DIGEST = hashlib.sha256().digest_size
_LENGTH = 8
"""Bytes that tell how long the JSON is."""
_ALIGNMENT = 16
"""Bytes to a multiple of which arrays are padded: the alignment of the widest numbers of NumPy."""
_NUMBERS = re.compile(r"[<>|][biufc]\d{1,2}")
"""Types of numbers, as NumPy writes them."""
_PLAIN = (type(None), bool, int, float, str)


class ForeignError(ModelError):
    """Bytes of others."""


class Packing:
    """Packs objects of some classes: named tuples, dataclasses, and others whose objects are their attributes."""

    def __init__(self, classes: Iterable[type]) -> None:
        self.classes = {cls.__name__: cls for cls in classes}

    def pack(self, value: Any) -> bytes:
        """Bytes of an object."""
        writer = _Writer(self)
        tree = json.dumps(writer.node(value), separators=(",", ":")).encode()
        content = b"".join([len(tree).to_bytes(_LENGTH, "little"), tree, *writer.arrays])
        signed = signature(content) + content
        return hashlib.sha256(signed).digest() + signed

    def unpack(self, data: bytes) -> Any:
        """The object of some bytes."""
        signed = memoryview(data)[_DIGEST:]
        if hashlib.sha256(signed).digest() != data[:_DIGEST]:
            raise ModelError("its checksum does not match its content")
        content = signed[SIGNATURE_SIZE:]
        if not is_signed(content, signed[:SIGNATURE_SIZE]):
            raise ForeignError(
                f"was not written by this user on this computer: it is not signed with the key {key_file()}. Its "
                "content would reach machine code. Copy the key of the other computer there if you trust the file"
            )
        try:
            end = _LENGTH + int.from_bytes(content[:_LENGTH], "little")
            return _Reader(self, content[end:]).value(json.loads(bytes(content[_LENGTH:end])))
        except ModelError:
            raise
        except Exception as error:  # a tree of others may be wrong in any way
            raise ModelError(f"{type(error).__name__}: {error}") from error


class _Writer:
    """Turns objects into a tree of JSON, and collects arrays."""

    def __init__(self, packing: Packing) -> None:
        self._packing = packing
        self.arrays: list[bytes] = []
        self._seen: dict[int, tuple[int, Any]] = {}

    def node(self, value: Any) -> Any:
        if type(value) in _PLAIN:
            return value
        if id(value) in self._seen:
            return {"is": "again", "of": self._seen[id(value)][0]}
        self._seen[id(value)] = len(self._seen), value  # which stays alive, so that no other gets its number
        return self._of_kind(value)

    def _of_kind(self, value: Any) -> dict[str, Any]:
        kind = type(value)
        if kind is list or kind is tuple:
            return {"is": kind.__name__, "of": [self.node(one) for one in value]}
        if kind is dict:
            return {"is": "dict", "of": [[self.node(key), self.node(one)] for key, one in value.items()]}
        if kind is complex:
            return {"is": "complex", "of": [value.real, value.imag]}
        if isinstance(value, np.ndarray):
            return {"is": "rows" if isinstance(value, np.recarray) else "array"} | self._array(value)
        if isinstance(value, np.generic):
            return {"is": "row" if isinstance(value, np.record) else "scalar"} | self._array(np.asarray(value))
        if kind is Drive or kind is Prepared:
            return {"is": kind.__name__.lower(), "of": (value.drive if kind is Prepared else value).text}
        return self._record(value)

    def _record(self, value: Any) -> dict[str, Any]:
        name = type(value).__name__
        if type(value) is not self._packing.classes.get(name):
            raise ModelError(f"{type(value).__module__}.{name} is not among the classes that are kept.")
        if isinstance(value, tuple):
            return {"is": name, "of": [self.node(one) for one in value]}
        state: Any = value.__getstate__()
        return {"is": name, "of": {key: self.node(one) for key, one in state.items()}}

    def _array(self, array: np.ndarray[Any, Any]) -> dict[str, Any]:
        order: Literal["C", "F"] = "F" if array.flags.f_contiguous and not array.flags.c_contiguous else "C"
        self.arrays.append(array.tobytes(order).ljust(_padded(array.nbytes), b"\0"))
        return {"type": _type_node(array.dtype), "shape": array.shape, "order": order}


class _Reader:
    """Makes objects of a tree, in the order in which they were written."""

    def __init__(self, packing: Packing, arrays: memoryview) -> None:
        self._packing, self._arrays, self._place = packing, arrays, 0
        self._made: list[Any] = []

    def value(self, node: Any) -> Any:
        if not isinstance(node, dict):
            if type(node) in _PLAIN:
                return node
            raise ModelError("a list stands where an object should")
        kind, content = node["is"], node.get("of")
        made: Any
        if kind == "again":
            return self._made[int(content or 0)]
        number = len(self._made)
        self._made.append(None)
        self._made[number] = made = self._of_kind(kind, node, content)
        return made

    def _of_kind(self, kind: str, node: dict[str, Any], content: Any) -> Any:
        if kind in ("list", "tuple"):
            items = [self.value(one) for one in content]
            return items if kind == "list" else tuple(items)
        if kind == "dict":
            return {self.value(key): self.value(one) for key, one in content}
        if kind == "complex":
            return complex(*content)
        if kind in ("array", "rows", "row", "scalar"):
            return self._array(kind, node)
        if kind == "drive":
            return drive_of_text(content)
        if kind == "prepared":
            return prepare(drive_of_text(content))
        if kind not in self._packing.classes:
            raise ModelError(f"{kind} has no place in it")
        cls = self._packing.classes[kind]
        if issubclass(cls, tuple):
            return cls(*(self.value(one) for one in content))
        made, state = cls.__new__(cls), {key: self.value(one) for key, one in content.items()}
        if hasattr(made, "__setstate__"):
            made.__setstate__(state)
        else:
            vars(made).update(state)
        return made

    def _array(self, kind: str, node: dict[str, Any]) -> Any:
        dtype, shape, order = _type(node["type"]), tuple(node["shape"]), node["order"]
        size = prod(shape) * dtype.itemsize
        stored = self._arrays[self._place : self._place + size]
        self._place += _padded(size)
        if len(stored) != size or size < 0:
            raise ModelError("an array ends behind its content")
        made = np.ndarray(shape, dtype, bytearray(stored), order=order).copy(order)
        if kind == "array":
            return made
        if kind == "scalar":
            return made[()]
        return made.view(np.recarray) if kind == "rows" else made.reshape(1).view(np.recarray)[0]


def _padded(size: int) -> int:
    """Bytes that an array takes, so that the next one is aligned."""
    return -(-size // _ALIGNMENT) * _ALIGNMENT


def _type_node(dtype: np.dtype[Any]) -> Any:
    """A type of numbers or of rows in JSON."""
    if dtype.subdtype is not None:
        base, shape = dtype.subdtype
        return {"base": _type_node(base), "shape": shape}
    if dtype.names is None:
        if not _NUMBERS.fullmatch(dtype.str):
            raise ModelError(f"an array of {dtype} is not among what is kept.")
        return dtype.str
    fields = [dtype.fields[name] for name in dtype.names]  # type: ignore[index]
    return {
        "names": dtype.names,
        "formats": [_type_node(field[0]) for field in fields],
        "offsets": [field[1] for field in fields],
        "itemsize": dtype.itemsize,
        "aligned": dtype.isalignedstruct,
    }


def _type(node: Any) -> np.dtype[Any]:
    """The type of a node."""
    if isinstance(node, str):
        if not _NUMBERS.fullmatch(node):
            raise ModelError(f"an array of {node} has no place in it")
        return np.dtype(node)
    if "base" in node:
        return np.dtype((_type(node["base"]), tuple(node["shape"])))
    layout = {key: node[key] for key in ("names", "offsets", "itemsize")}
    formats = {"formats": [_type(one) for one in node["formats"]]}
    made: np.dtype[Any] = np.dtype(layout | formats, align=bool(node["aligned"]))  # type: ignore[call-overload]
    return made

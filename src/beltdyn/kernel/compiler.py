"""Compilation by Numba: its public decorator, or a quicker way through known internals."""

import functools
import warnings
from collections.abc import Callable, Iterable, Iterator
from contextlib import suppress
from typing import Any

import numba
from numba.core import event
from numba.core.errors import NumbaExperimentalFeatureWarning
from numba.extending import overload

from beltdyn.kernel.dispatch import CompilationCount, Dispatch
from beltdyn.kernel.fingerprint import SealedFolder, compiles_quickly, holds_kernels, kernel_cache, own_classes, setting

# where rows of a type begin as those of another one, Numba tells so at length, and takes the type that is exact
warnings.filterwarnings("ignore", r"(?s).* has been considered a subtype of ", NumbaExperimentalFeatureWarning)

OPTIONS = {"nogil": True, "error_model": "numpy", "fastmath": {"contract", "nsz"}}
"""Options of every kernel."""


class PlainCompilationWarning(UserWarning):
    """Kernels are compiled by Numba's public decorator, which takes longer."""


def new_dispatcher(function: Callable[..., Any], inline: bool) -> Any:
    """Make a dispatcher that compiles a function at its first call."""
    if numba.config.DISABLE_JIT:
        return function
    if compiles_quickly():
        from beltdyn.kernel.quick import QuickDispatcher

        return QuickDispatcher(function, {"nopython": True, **OPTIONS}, inline, kernel_cache())
    _say_once()
    sealed = _sealed_folder()
    while Dispatch.unregistered:
        _register(Dispatch.unregistered.pop())
    dispatcher = numba.njit(forceinline=inline, **OPTIONS)(function)
    if own_classes():  # Numba's cache would take a changed law for the same
        return dispatcher
    with setting("CACHE_DIR", str(sealed.folder)), suppress(RuntimeError):  # no file holds what was typed
        dispatcher.enable_caching()
    return _Sealing(dispatcher, sealed)


class _Sealing:
    """Numba's dispatcher, with checksums for what it puts on disk."""

    def __init__(self, dispatcher: Any, folder: SealedFolder) -> None:
        self._dispatcher, self._sealed_folder = dispatcher, folder

    def __call__(self, *args: Any, **kwargs: Any) -> Any:
        known = len(self._dispatcher.signatures)
        try:
            return self._dispatcher(*args, **kwargs)
        finally:
            if len(self._dispatcher.signatures) > known:
                self._sealed_folder.seal()

    def __getattr__(self, name: str) -> Any:
        return getattr(self._dispatcher, name)


def _register(choice: Dispatch) -> None:
    """Tell Numba which kernel a choice by type stands for."""
    overload(choice, jit_options=OPTIONS, strict=False)(
        lambda subject, *rest: choice.kernel_for(subject, *rest).py_func
    )


@functools.cache
def _sealed_folder() -> SealedFolder:
    return SealedFolder(kernel_cache())


@functools.cache
def _say_once() -> None:
    """Say, where nothing is compiled yet, that the first start takes longer."""
    if holds_kernels(kernel_cache()):
        return
    warnings.warn(
        f"Kernels are compiled by the public decorator of Numba {numba.__version__}: the first start takes some "
        "minutes. Later starts and results are not affected.",
        PlainCompilationWarning,
        stacklevel=4,
    )


class _Listener(event.Listener):  # type: ignore[misc]
    """Counts the functions that Numba compiles."""

    def __init__(self) -> None:
        self._count = CompilationCount()

    def on_start(self, event: event.Event) -> None:
        """Count a function that is begun."""
        data = event.data
        self._count.begin(data["dispatcher"].py_func, frozenset(_classes(data["args"])))

    def on_end(self, event: event.Event) -> None:
        """Count a function that is compiled."""
        self._count.end()


def _classes(types: Iterable[Any]) -> Iterator[type]:
    """Classes of named tuples among types of arguments, those within others too."""
    for one in types:
        if hasattr(one, "instance_class"):
            yield one.instance_class
            yield from _classes(one.types)


event.register("numba:compile", _Listener())

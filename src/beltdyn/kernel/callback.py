"""User functions, called by kernels through their addresses."""

import ctypes
import time
import warnings
from _thread import interrupt_main, start_new_thread
from collections.abc import Callable
from functools import cache, cached_property
from typing import Any

_C_FUNCTION = ctypes.CFUNCTYPE(ctypes.c_double, ctypes.c_double, ctypes.c_double, ctypes.c_double)
_TIMED_CALLS = 200
"""Calls over which the time of one is averaged for the warning: the time of a single one varies too much."""
_BACK = 0.01
"""Time in which machine code comes back to Python, s; where it has not, Ctrl-C is repeated once more."""
_kept: list[Any] = []
"""Machine code keeps its address while the process runs."""


class SlowFunctionWarning(UserWarning):
    """A function that Numba cannot compile."""


@cache
def address_of(function: Callable[[float, float, float], float]) -> int:
    """Make a function of three numbers callable from kernels."""
    from numba import cfunc

    try:
        compiled = cfunc("float64(float64, float64, float64)", error_model="numpy")(function)
    except Exception as error:  # what Numba does not compile makes it raise many types
        return _address_of_python(function, _reason(error))
    _kept.append(compiled)
    return int(compiled.address)


def _address_of_python(function: Callable[[float, float, float], float], reason: str) -> int:
    """Address of code by which Python runs a function."""

    def run(first: float, second: float, third: float) -> float:
        try:
            return float(function(first, second, third))
        except BaseException as error:  # it cannot pass through machine code: the solver rejects what is no number
            if isinstance(error, Exception):
                warnings.warn(f"{_name(function)} failed: {error!r}", RuntimeWarning, stacklevel=2)
            else:
                start_new_thread(_interrupt_again, ())
            return float("nan")

    callback = _C_FUNCTION(run)
    begin = time.perf_counter()
    for _ in range(_TIMED_CALLS):
        callback(0.0, 0.0, 0.0)
    cost = (time.perf_counter() - begin) / _TIMED_CALLS
    warnings.warn(
        f"Numba cannot compile {_name(function)} ({reason}): Python runs it, {1e6 * cost:.2g} microseconds per call "
        "and several calls per time step. To make it fast, use only numbers and functions of math.",
        SlowFunctionWarning,
        stacklevel=4,
    )
    _kept.append(callback)
    return int(ctypes.cast(callback, ctypes.c_void_p).value or 0)


def _interrupt_again() -> None:
    """Repeat Ctrl-C when machine code has come back to Python."""
    time.sleep(_BACK)
    interrupt_main()


def _reason(error: Exception) -> str:
    """The line of Numba's message that says what is wrong: the first one names a step of the compiler."""
    lines = [line for line in str(error).splitlines() if line.strip()]
    return lines[min(1, len(lines) - 1)].strip() if lines else type(error).__name__


def _name(function: Callable[..., Any]) -> str:
    return f'the function "{getattr(function, "__name__", function)}"'


class CallAt:
    """The call of an address with three numbers, for kernels and Python."""

    def __call__(self, address: int, first: float, second: float, third: float) -> float:
        """Call the function at an address."""
        return float(_C_FUNCTION(int(address))(first, second, third))

    @property
    def _numba_type_(self) -> Any:
        """Type by which kernels know it."""
        return self._type

    @cached_property
    def _type(self) -> Any:
        from llvmlite import ir
        from numba import types
        from numba.core.registry import cpu_target
        from numba.extending import intrinsic

        def call(_context: Any, address: Any, first: Any, second: Any, third: Any) -> Any:
            def generate(_target: Any, builder: Any, _signature: Any, arguments: Any) -> Any:
                number = ir.DoubleType()
                pointer = ir.FunctionType(number, [number] * 3).as_pointer()
                return builder.call(builder.inttoptr(arguments[0], pointer), arguments[1:])

            return types.float64(types.int64, types.float64, types.float64, types.float64), generate

        known = intrinsic(call)
        cpu_target.typing_context.refresh()
        return cpu_target.typing_context.resolve_value_type(known)


call_at = CallAt()
"""The value of a function at an address, from `address_of`, for three numbers."""

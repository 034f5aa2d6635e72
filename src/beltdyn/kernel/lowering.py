"""How the code of kernels is written: shorter than Numba's, with the same results.

Numba hands each field of a named tuple to a function by itself, seven of an array, and takes tuples apart and puts them
together again at every call.  Here a named tuple reaches a kernel by reference, and a field is read where it lies.
Numba also clears each variable that is no longer used; kernels own no memory, so that nothing needs it.

Machine code is that of a level of processors and not of one model: kernels that are shipped run wherever they would be
compiled the same, and are no slower.
"""

from collections import Counter
from functools import cached_property
from typing import Any

import numba
from llvmlite import ir
from llvmlite.binding import get_host_cpu_features
from numba.core import cgutils, types
from numba.core.callconv import CPUCallConv
from numba.core.codegen import JITCPUCodegen
from numba.core.compiler import Compiler
from numba.core.compiler_machinery import register_pass
from numba.core.cpu import CPUContext
from numba.core.datamodel.models import TupleModel, UniTupleModel
from numba.core.ir import Arg, Assign
from numba.core.lowering import Lower
from numba.core.registry import CPUTarget, cpu_target
from numba.core.typed_passes import BaseNativeLowering, NativeLowering
from numba.core.typing import Context

# Arguments


class _ByReference:
    """What a model of a named tuple says of arguments."""

    def get_argument_type(self) -> Any:
        """A pointer to the value."""
        return self.get_value_type().as_pointer()  # type: ignore[attr-defined]

    def as_argument(self, builder: Any, value: Any) -> Any:
        """Where a value lies: that of a variable where the variable does."""
        if _lies_still(builder.block, value):
            return value.operands[0]
        place = _room(builder, value.type)
        builder.store(value, place)
        return place

    def from_argument(self, _builder: Any, value: Any) -> Any:
        """The place of the value: its variable lies there."""
        return value


def _room(builder: Any, kind: Any, name: str = "") -> Any:
    """Room on the stack, which Numba would clear."""
    with builder.goto_entry_block():
        return builder.alloca(kind, name=name)


def _lies_still(block: Any, value: Any) -> bool:
    """Whether a value was loaded in a block from a variable that cannot have changed since."""
    if not isinstance(value, ir.LoadInstr):
        return False
    if isinstance(value.operands[0], ir.Argument):
        return True
    for instruction in reversed(block.instructions if isinstance(value.operands[0], ir.AllocaInstr) else ()):
        if instruction is value:
            return True
        if isinstance(instruction, ir.StoreInstr):
            return False
    return False


class _NamedTuple(_ByReference, TupleModel):  # type: ignore[misc]
    """A named tuple."""


class _NamedUniTuple(_ByReference, UniTupleModel):  # type: ignore[misc]
    """A named tuple whose fields have one type."""


class _Convention(CPUCallConv):  # type: ignore[misc]
    """Numba's convention of calls; nobody writes where a named tuple lies while it is an argument."""

    def decorate_function(self, function: Any, names: Any, argument_types: Any, **choices: Any) -> None:
        """Give arguments names and attributes."""
        super().decorate_function(function, names, argument_types, **choices)
        places = iter(self.get_arguments(function))
        for kind in argument_types:
            model = self.context.data_model_manager[kind]
            if isinstance(model, _ByReference):
                place = next(places)
                place.add_attribute("noalias")
            else:
                for _ in self._get_arg_packer([kind]).argument_types:
                    next(places)


_LEVEL = "x86-64-v3"
_LEVEL_HAS = frozenset({"64bit", "avx2", "bmi", "bmi2", "f16c", "fma", "lzcnt", "movbe"})
"""A level of processors, from 2013 on, and the features that it adds."""


class _Codegen(JITCPUCodegen):  # type: ignore[misc]
    """Numba's code generator, for the level of the processor where it has one, unless a processor is asked for."""

    @cached_property
    def _has_level(self) -> bool:
        asked = numba.config.CPU_NAME is not None or numba.config.CPU_FEATURES is not None
        return not asked and all(get_host_cpu_features().get(one) for one in _LEVEL_HAS)

    def _get_host_cpu_name(self) -> Any:
        return _LEVEL if self._has_level else super()._get_host_cpu_name()

    def _get_host_cpu_features(self) -> Any:
        return "" if self._has_level else super()._get_host_cpu_features()


class _Context(CPUContext):  # type: ignore[misc]
    """Numba's context with these models, and its own code generator; all else is shared."""

    def __init__(self, common: CPUContext) -> None:
        self.__dict__.update(vars(common))
        self._internal_codegen = _Codegen("beltdyn")
        self.data_model_manager = common.data_model_manager.copy()
        self.data_model_manager.register(types.NamedTuple, _NamedTuple)
        self.data_model_manager.register(types.NamedUniTuple, _NamedUniTuple)
        self.cached_internal_func: dict[Any, Any] = {}

    @property
    def call_conv(self) -> _Convention:
        """Convention of calls."""
        return _Convention(self)


class _Typing(Context):  # type: ignore[misc]
    """Numba's context of types, which remembers the types of operations on numbers and arrays."""

    def __init__(self, common: Context) -> None:
        self.__dict__ = vars(common)  # the same, not a copy: Numba adds to it
        _known.clear()

    def resolve_function_type(self, function: Any, args: Any, kws: Any) -> Any:
        """The signature of a call."""
        plain = isinstance(function, types.Function) and not kws
        if not plain or not all(isinstance(one, _OPERANDS) for one in args):
            return super().resolve_function_type(function, args, kws)
        call = function, tuple(args)
        if call not in _known:
            _known[call] = super().resolve_function_type(function, args, kws)
        return _known[call]


_OPERANDS = types.Number, types.Boolean, types.Array, types.UniTuple
_known: dict[Any, Any] = {}
"""Signatures of calls with these operands."""


class _Target(CPUTarget):  # type: ignore[misc]
    @cached_property
    def _toplevel_target_context(self) -> _Context:
        return _Context(cpu_target.target_context)

    @cached_property
    def _toplevel_typing_context(self) -> "_Typing":
        return _Typing(cpu_target.typing_context)


TARGET = _Target("cpu")
"""What kernels are compiled for."""

# Statements


class _Lower(Lower):  # type: ignore[misc]
    """Writes the code of a kernel."""

    def init(self) -> None:
        """Find arguments that their function does not assign to: their variables lie with the caller."""
        super().init()
        assigned = [one for block in self.blocks.values() for one in block.find_insts(Assign)]
        count = Counter(one.target.name for one in assigned)
        self._lent = {
            one.target.name
            for one in assigned
            if isinstance(one.value, Arg) and count[one.target.name] == 1 and self._by_reference(one.target.name)
        }
        self._singly_assigned_vars -= self._lent

    def _by_reference(self, name: str) -> bool:
        return isinstance(self.context.data_model_manager[self.typeof(name)], _ByReference)

    def lower_assign(self, kind: Any, inst: Any) -> Any:
        """Load an argument where it becomes another variable."""
        value = super().lower_assign(kind, inst)
        if isinstance(inst.value, Arg) and inst.target.name not in self._lent and self._by_reference(inst.target.name):
            return self.builder.load(value)
        return value

    def storevar(self, value: Any, name: str, argidx: int | None = None) -> None:
        """Store the value of a variable; the one before needs no clearing."""
        if name in self._lent:
            self.varmap[name] = value
        elif name in self._singly_assigned_vars:
            super().storevar(value, name, argidx)
        else:
            self._alloca_var(name, self.typeof(name))
            self.builder.store(value, self.getvar(name))

    def alloca_lltype(self, name: str, lltype: Any, datamodel: Any = None) -> Any:
        """Room for a variable."""
        return _room(self.builder, lltype, name)

    def delvar(self, name: str) -> None:
        """Leave a variable that is no longer used."""

    def lower_expr(self, kind: Any, expr: Any) -> Any:
        """Read a field of a named tuple where it lies."""
        if expr.op == "getattr" and expr.value.name not in self._blk_local_varmap:
            owner = self.typeof(expr.value.name)
            if isinstance(owner, types.BaseNamedTuple) and expr.attr in owner.fields:
                number = owner.fields.index(expr.attr)
                field = self.builder.load(cgutils.gep_inbounds(self.builder, self.getvar(expr.value.name), 0, number))
                return self.context.cast(self.builder, field, owner[number], kind)
        return super().lower_expr(kind, expr)


@register_pass(mutates_CFG=True, analysis_only=False)
class _Lowering(BaseNativeLowering):  # type: ignore[misc]
    _name = "kernel_lowering"

    @property
    def lowering_class(self) -> type[_Lower]:
        return _Lower


class KernelCompiler(Compiler):  # type: ignore[misc]
    """Numba's compiler, which writes code so."""

    def define_pipelines(self) -> list[Any]:
        """The passes of compilation."""
        pipelines: list[Any] = super().define_pipelines()
        for pipeline in pipelines:
            pipeline.passes = [(_Lowering if one is NativeLowering else one, *rest) for one, *rest in pipeline.passes]
            pipeline.finalize()
        return pipelines

"""Compilation in a third of the time, by way of Numba's internals.

Numba optimizes a kernel and turns it into machine code before it links it into its callers, which do so again.
Here a kernel is linked into its callers before optimization.  Only the kernels that Python calls are optimized, each
with all that it calls, and kept on disk.

How the code of kernels is written: shorter than Numba's, with the same results.

Numba hands each field of a named tuple to a function by itself, seven of an array, and takes tuples apart and puts them
together again at every call.  Here a named tuple reaches a kernel by reference, and a field is read where it lies.
Numba also clears each variable that is no longer used; kernels own no memory, so that nothing needs it.

Machine code is that of a level of processors and not of one model: kernels that are shipped run wherever they would be
compiled the same, and are no slower.
"""

import gc
import hashlib
import io
import pickle
import re
import sys
from collections import Counter
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from functools import cache, cached_property
from pathlib import Path
from typing import Any

import numba
from filelock import FileLock
from llvmlite import ir
from llvmlite.binding import get_host_cpu_features, parse_assembly
from numba.core import cgutils, types
from numba.core.caching import NullCache
from numba.core.callconv import CPUCallConv
from numba.core.codegen import JITCodeLibrary, JITCPUCodegen
from numba.core.compiler import Compiler, CompileResult
from numba.core.compiler_machinery import register_pass
from numba.core.cpu import CPUContext
from numba.core.datamodel.models import TupleModel, UniTupleModel
from numba.core.ir import Arg, Assign
from numba.core.lowering import Lower
from numba.core.registry import CPUDispatcher, CPUTarget, cpu_target
from numba.core.serialize import NumbaPickler
from numba.core.typed_passes import BaseNativeLowering, NativeLowering
from numba.core.types.misc import unliteral
from numba.core.typing import Context

from beltdyn.kernel.fingerprint import (
    ENTRY,
    PACKAGE,
    fingerprint,
    is_own,
    mark_of,
    marked,
    marks_in,
    read_sealed,
    setting,
    warn_of_damage,
    write_sealed,
)

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


_NO_EXTRAS = {"no_cfunc_wrapper": True, "no_rewrites": True, "_nrt": False}
"""Left away: functions for C, rewriting passes, Numba's memory management; kernels need none of them."""

_PATIENCE = 600.0
"""Seconds after which a kernel is compiled although another process is said to compile it: none takes so long."""

_OPTIMISATION = type(numba.config.OPT)(1)
"""LLVM's level: a higher one takes a fifth longer to compile, and the code is no faster."""


class _Callee(CPUDispatcher):  # type: ignore[misc]
    """A kernel as others call it."""

    targetdescr = TARGET


class QuickDispatcher(CPUDispatcher):  # type: ignore[misc]
    """A compiled function that shows itself to other kernels as code to be optimized along with them."""

    targetdescr = TARGET

    def __init__(self, function: Any, options: dict[str, Any], inline: bool, folder: Path) -> None:
        self._options = options | _NO_EXTRAS
        super().__init__(function, {}, self._options, KernelCompiler)
        self._inline = inline
        self._folder = folder

    @cached_property
    def _code(self) -> CPUDispatcher:
        """What another kernel calls."""
        inlined = {"forceinline": self._inline, "no_cpython_wrapper": True}
        return _Callee(self.py_func, {}, self._options | inlined, _CodeCompiler)

    def get_call_template(self, args: Any, kws: Any) -> Any:
        """Type a call by another kernel, constants like any other number."""
        return self._code.get_call_template([unliteral(argument) for argument in args], kws)

    def get_overload(self, sig: Any) -> Any:
        """What another kernel calls, for some types of arguments."""
        return self._code.get_overload(sig)

    def compile(self, sig: Any) -> Any:
        """Compile, or load from disk, without the pauses that Python makes to look through the compiler's objects.

        Where another process compiles the same, it is waited for.
        """
        entry = self._entry(sig)
        collecting = gc.isenabled()
        gc.disable()
        try:
            with setting("OPT", _OPTIMISATION), _alone(entry):
                return super().compile(sig)
        finally:
            if collecting:
                gc.enable()

    def is_kept(self, arguments: tuple[Any, ...]) -> bool:
        """Whether a call with these arguments needs no compilation."""
        sig = tuple(map(self.typeof_pyval, arguments))
        entry = self._entry(sig)
        return sig in self.overloads or (entry is not None and entry.is_file())

    @cached_property
    def _files(self) -> "_Cache | None":
        """Where its machine code is kept; nowhere without a file that its source comes from."""
        with suppress(OSError):
            return _Cache(self.py_func, self._folder)
        return None

    def _entry(self, sig: Any) -> Path | None:
        if self._files is None:
            return None
        self._cache = self._files
        return self._files.entry(sig, self.targetctx)


@contextmanager
def _alone(entry: Path | None) -> Iterator[None]:
    """Keep other processes from what is done for an entry of the cache, where its file system has locks."""
    if entry is None:
        yield
        return
    lock = FileLock(entry.with_suffix(".lock"), timeout=_PATIENCE)
    with suppress(NotImplementedError, OSError):  # of which a lock that was waited for in vain is one
        lock.acquire()
    try:
        yield
    finally:
        with suppress(OSError):
            lock.release()


def choice_type(kernel_for: Callable[..., Any]) -> Any:
    """Type of a function with several kernels."""
    return _ChoiceType(_Choice(kernel_for))


class _Choice:
    """What another kernel calls, when it is compiled, in place of the kernel that is chosen."""

    is_compiling, nopython_signatures = False, ()

    def __init__(self, kernel_for: Callable[..., Any]) -> None:
        self._kernel_for = kernel_for

    def get_call_template(self, args: Any, kws: Any) -> Any:
        """Type a call."""
        return self._kernel_for(*args).dispatcher.get_call_template(args, kws)

    def get_overload(self, sig: Any) -> Any:
        """What is called, for some types of arguments."""
        return self._kernel_for(*sig).dispatcher.get_overload(sig)


class _ChoiceType(numba.types.Dispatcher):  # type: ignore[misc]
    """A type that keeps its choice alive: Numba's holds a compiled function weakly."""

    def __init__(self, choice: _Choice) -> None:
        self._choice = choice
        super().__init__(choice)


class _Cache(NullCache):  # type: ignore[misc]
    """Machine code on disk, a sealed file for a kernel and some types of arguments.

    It loads without filling the tables that only compilation needs.
    """

    def __init__(self, function: Any, folder: Path) -> None:
        file = Path(function.__code__.co_filename)
        self._folder = folder
        stem, name = (re.sub("[^A-Za-z0-9_.]", "", text)[-80:] for text in (file.stem, function.__qualname__))
        self._name = f"{stem}.{name}"
        origin = (str(file), fingerprint([function])) if is_own(function) else (file.relative_to(PACKAGE).as_posix(),)
        self._source = (numba.__version__, sys.version_info[:3], *origin, *_fingerprint(function))

    @property
    def cache_path(self) -> str:
        """Folder of the entries."""
        return str(self._folder)

    def entry(self, sig: Any, target_context: Any) -> Path:
        """File of the code for some types of arguments."""
        digest = hashlib.sha256(repr(self._key(sig, target_context)).encode()).hexdigest()
        return self._folder / f"{self._name}-{digest[:16]}{ENTRY}"

    def _key(self, sig: Any, target_context: Any) -> tuple[Any, ...]:
        return sig, target_context.codegen().magic_tuple(), self._source, sorted(marks_in(sig))

    def load_overload(self, sig: Any, target_context: Any) -> Any:
        """Load the machine code for some types of arguments; None where there is none."""
        path = self.entry(sig, target_context)
        content = read_sealed(path)
        if content is None:
            return None
        try:
            key, stored = _Unpickler(io.BytesIO(content)).load()
            return CompileResult._rebuild(target_context, *stored) if key == self._key(sig, target_context) else None
        except Exception:  # whatever an entry of other libraries lets the unpickler or LLVM raise
            warn_of_damage(path.parent)
            return None

    def save_overload(self, sig: Any, data: Any) -> None:
        """Keep the machine code for some types of arguments, without what only its compiler needs."""
        if data.lifted or data.library.has_dynamic_globals:
            return
        (name, kind, (machine_code, _)), *rest = data._replace(type_annotation="")._reduce()
        entry = f'define void @"{data.fndesc.llvm_cpython_wrapper_name}"() {{ ret void }}'
        stored = (name, kind, (machine_code, parse_assembly(entry).as_bitcode())), *rest
        write_sealed(self.entry(sig, data.target_context), dumps((self._key(sig, data.target_context), stored)))


class _Pickler(NumbaPickler):  # type: ignore[misc]
    """Numba's, by which classes of users' laws are kept by their marks: those of a script have no other name."""

    def persistent_id(self, value: Any) -> str | None:
        """The mark of a class."""
        return mark_of(value)


class _Unpickler(pickle.Unpickler):
    """Finds classes by their marks."""

    def persistent_load(self, mark: str) -> type:
        """The class of a mark."""
        return marked(mark)


def dumps(value: Any) -> bytes:
    """Bytes of a value."""
    with io.BytesIO() as buffer:
        _Pickler(buffer, protocol=4).dump(value)
        return buffer.getvalue()


def _fingerprint(function: Any) -> tuple[Any, ...]:
    """What tells a function from others, and from what its file held before an edit, however Python compiles it."""
    code, closure = function.__code__, function.__closure__ or ()
    content = hashlib.sha256(_content(code.co_filename)).hexdigest()
    return code.co_firstlineno, content, fingerprint(cell.cell_contents for cell in closure)


@cache
def _content(file: str) -> bytes:
    return Path(file).read_bytes()


class _CodeCompiler(KernelCompiler):
    """Numba's compiler, up to the code before optimization."""

    def __init__(self, typingctx: Any, targetctx: Any, _library: Any, *choices: Any) -> None:
        super().__init__(typingctx, targetctx, _Code(targetctx.codegen(), "code"), *choices)


class _Code(JITCodeLibrary):  # type: ignore[misc]
    """Code of a kernel with all that it calls, neither optimized as a whole nor turned into machine code."""

    def finalize(self) -> None:
        """Link what it calls, and no more."""
        for library in dict.fromkeys(self._linking_libraries):
            self._final_module.link_in(library._get_module_for_linking(), preserve=True)
        self._finalized = True

    def get_pointer_to_function(self, _name: str) -> int:
        """No machine code, no address."""
        self._ensure_finalized()
        return 0

    @property
    def codegen(self) -> "_Code":
        """What Numba asks to `set_env`."""
        return self

    def set_env(self, _name: str, _environment: Any) -> None:
        """Nothing to set: the environment is for Python objects, which kernels do not see."""

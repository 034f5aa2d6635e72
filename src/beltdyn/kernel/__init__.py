"""Compiled code: the decorator of kernels and the cache of their machine code."""

from beltdyn.kernel.decorator import Kernel, interpreted, kernel, runs_compiled
from beltdyn.kernel.dispatch import (
    CompilationReport,
    by_type,
    observe_compilation,
    report_compilation,
    watch_compilation,
)
from beltdyn.kernel.fingerprint import (
    CACHE_VARIABLE,
    PACKAGE,
    PLAIN_VARIABLE,
    KernelCacheWarning,
    compiles_quickly,
    holds_kernels,
    kernel_cache,
    source_hash,
)
from beltdyn.kernel.rows import KernelKinds, KindRows, choice, labels

__all__ = [
    "CACHE_VARIABLE",
    "PACKAGE",
    "PLAIN_VARIABLE",
    "CompilationReport",
    "Kernel",
    "KernelCacheWarning",
    "KernelKinds",
    "KindRows",
    "by_type",
    "choice",
    "compiles_quickly",
    "holds_kernels",
    "interpreted",
    "kernel",
    "kernel_cache",
    "labels",
    "observe_compilation",
    "report_compilation",
    "runs_compiled",
    "source_hash",
    "watch_compilation",
]

"""The results of a run: one labeled dataset, its file, and what is derived from it."""

from importlib import import_module
from typing import TYPE_CHECKING, Any

from beltdyn.results.checks import Finding
from beltdyn.results.energy_balance import Balance, power_balance
from beltdyn.results.export import export
from beltdyn.results.incidents import Jump, jumps
from beltdyn.results.layout import Layout, describe_size, expected_bytes, require_room
from beltdyn.results.limits import KeyNumber, key_numbers
from beltdyn.results.means import PulleySummary, SpanSummary, TensionerSummary
from beltdyn.results.provenance import Resolution, mesh_error_attribute, provenance
from beltdyn.results.recorder import FileRecorder, MemoryRecorder, Recorder, Status
from beltdyn.results.result import Result, build_result
from beltdyn.results.run import Run, StaticResult, open_result, open_run, static_result
from beltdyn.results.schema import COORDINATES, RECORDED, VARIABLES, Variable
from beltdyn.results.summary import Compared, Summary, steady_comparison, summarize
from beltdyn.results.tables import write_csv
from beltdyn.results.tooth_loads import ToothLoads, tooth_loads

if TYPE_CHECKING:
    from beltdyn.results import derived

__all__ = [
    "COORDINATES",
    "RECORDED",
    "VARIABLES",
    "Balance",
    "Compared",
    "FileRecorder",
    "Finding",
    "Jump",
    "KeyNumber",
    "Layout",
    "MemoryRecorder",
    "PulleySummary",
    "Recorder",
    "Resolution",
    "Result",
    "Run",
    "SpanSummary",
    "StaticResult",
    "Status",
    "Summary",
    "TensionerSummary",
    "ToothLoads",
    "Variable",
    "build_result",
    "derived",
    "describe_size",
    "expected_bytes",
    "export",
    "jumps",
    "key_numbers",
    "mesh_error_attribute",
    "open_result",
    "open_run",
    "power_balance",
    "provenance",
    "require_room",
    "static_result",
    "steady_comparison",
    "summarize",
    "tooth_loads",
    "write_csv",
]


def __getattr__(name: str) -> Any:
    """Import modules that need xarray on first use."""
    if name == "derived":
        return import_module("beltdyn.results.derived")
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")

"""Provenance of results, and differences between drives."""

import hashlib
import json
from collections.abc import Mapping, Sequence
from typing import Any

from beltdyn.parts.messages import show
from beltdyn.parts.text_file import as_text
from beltdyn.results import Result, Run
from beltdyn.results.provenance import mesh_facts
from beltdyn.results.schema import runs_steadily
from beltdyn.show.plot.headline import given_keys

# The charting library of the page (Bokeh, BSD license), taken from its installation, and what it is given

_NAME = "figures"


def library() -> str:
    """The library as the text of a script; it fetches nothing."""
    from bokeh.resources import INLINE

    return str(INLINE.js_raw[0])


def embedded(parts: Mapping[str, Any]) -> str:
    """Write what the page's script reads, safe inside a page."""
    content: Any = dict(parts)
    if parts and not all(isinstance(part, dict) for part in parts.values()):
        content = _document(parts)
    return json.dumps(content, separators=(",", ":")).replace("<", "\\u003c")


def _document(charts: Mapping[str, Any]) -> dict[str, Any]:
    """A document of Bokeh as plain values, whose arrays are in base64, and where its parts stand."""
    from bokeh.core.json_encoder import serialize_json
    from bokeh.document import Document

    document = Document()
    with document.models.freeze():  # else all charts are gone through once more with each
        for chart in charts.values():
            document.add_root(chart)
    roots = {chart.id: place for place, chart in charts.items()}
    return {
        "documents": {_NAME: json.loads(serialize_json(document.to_json(deferred=False)))},
        "items": [{"docid": _NAME, "root_ids": list(roots), "roots": roots}],
    }


_MOST_DIFFERENCES = 40


def origin(result: Result) -> list[tuple[str, str]]:
    """Facts about how a result was made."""
    said = result.dataset.attrs
    packages = ("beltdyn", "numba", "numpy", "scipy", "python")
    versions = ", ".join(f"{name} {said[f'{name}_version']}" for name in packages if f"{name}_version" in said)
    facts = [
        ("analysis", f"{analysis_of(result)}, {result.status}"),
        ("versions", versions),
        ("computed", str(said.get("created", "unknown"))),
        ("format of the result file", str(said.get("format", "unknown"))),
        ("SHA-256 of the drive", _hash(result.drive.text.encode())),
    ]
    if result.path is not None and result.path.is_file():
        facts += [(f"SHA-256 of {as_text(result.path.name)}", _hash(result.path.read_bytes()))]
    settings = result.drive.simulation
    if isinstance(result, Run):
        integrator = said.get("integrator", settings.integrator)
        facts += [("integrator", f"{integrator}, rtol {settings.rtol:g}, start {settings.start}")]
    facts += mesh_facts(said)
    facts += [(choice.key, choice.words) for choice in result.prepared.choices]
    return facts


def analysis_of(result: Result) -> str:
    """Name of the analysis: of a run, whether it is steady running or a sweep."""
    if isinstance(result, Run) and runs_steadily(result.dataset):
        return "steady"
    return "sweep" if "swept_pulley" in result.dataset.attrs else result.kind.replace("_", " ")


def differing_keys(results: Sequence[Result]) -> list[tuple[str, list[str]]]:
    """Give the keys of drive files in which drives differ, with their values."""
    given = [given_keys(result) for result in results]
    keys = dict.fromkeys(key for one in given for key in one)
    values = {key: [show(one[key]) if key in one else "by default" for one in given] for key in keys}
    return [(key, row) for key, row in values.items() if len(set(row)) > 1][:_MOST_DIFFERENCES]


def _hash(content: bytes) -> str:
    return hashlib.sha256(content).hexdigest()

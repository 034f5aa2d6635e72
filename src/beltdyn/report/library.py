"""The charting library of the page (Bokeh, BSD licence), taken from its installation, and what it is given."""

import json
from collections.abc import Mapping
from typing import Any

_NAME = "figures"


def library() -> str:
    """The library as the text of a script; it fetches nothing."""
    from bokeh.resources import INLINE

    return str(INLINE.js_raw[0])


def embedded(parts: Mapping[str, Any]) -> str:
    """Write what the page's script reads, safe inside a page.

    Parameters
    ----------
    parts : mapping
        Place on the page -> a chart of Bokeh, or a mapping of plain values.

    Returns
    -------
    str
        JSON without the letter that begins a tag: of charts a document of Bokeh, and where its parts stand.
    """
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

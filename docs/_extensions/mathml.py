"""Formulas of the pages as MathML, which browsers show by themselves: no script, no font and no network is needed."""

import re
from typing import Any

from docutils import nodes
from latex2mathml.converter import convert
from sphinx.application import Sphinx

_TAG = re.compile(r"\\tag\{(.*?)\}")
_PLAIN = (
    (re.compile(r"\\(mathbf|mathcal|mathsf)\s*([A-Za-z])"), r"\\\1{\2}"),
    (re.compile(r"\\boldsymbol\s*\{?(\\[a-z]+)\}?"), r"\1"),
    (re.compile(r"\\tfrac"), r"\\frac"),
    (re.compile(r"\\[Bb]ig+[lr]?(?![a-z])"), ""),
    (re.compile(r"\\[lr]vert"), "|"),
    (re.compile(r"\\[lr]Vert"), r"\\|"),
    (re.compile(r"\{aligned\}"), "{split}"),
    (re.compile(r"\\(begin|end)\{equation\*?\}"), ""),
)
"""What the converter does not know, or browsers do not show, and what says the same."""


def written(formula: str, display: bool) -> str:
    """Write a formula as MathML.

    Parameters
    ----------
    formula : str
        In LaTeX, without dollars.
    display : bool
        Whether it stands on a line of its own; a number ``\\tag{1}`` stands at its end then.
    """
    tags = _TAG.findall(formula)
    text = _TAG.sub("", formula).strip()
    for pattern, plain in _PLAIN:
        text = pattern.sub(plain, text)
    found = convert(text, display="block" if display else "inline")
    number = f'<span class="eqno">({", ".join(tags)})</span>' if tags else ""
    return f'<div class="formula">{found}{number}</div>' if display else found


def _inline(visitor: Any, node: nodes.math) -> None:
    visitor.body.append(written(node.astext(), display=False))
    raise nodes.SkipNode


def _block(visitor: Any, node: nodes.math_block) -> None:
    visitor.body.append(written(node.astext(), display=True))
    raise nodes.SkipNode


def setup(app: Sphinx) -> dict[str, bool]:
    """Register the renderer."""
    app.add_html_math_renderer("mathml", (_inline, None), (_block, None))
    return {"parallel_read_safe": True, "parallel_write_safe": True}

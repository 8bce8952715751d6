"""How objects show themselves: a line in a terminal, a table in a notebook."""

from __future__ import annotations

import html
from typing import Any, Iterable

import numpy as np

from .units import unit_of


class Answer(dict):
    """What a command writes with ``--json`` (docs/json.md): a dict in which lists of numbers are arrays, null in them NaN.

    ``summary`` is what the command prints, of a run, uncertainty and campaign; others have none. ``dict(answer)`` shows everything.
    """

    def __init__(self, json: dict[str, Any], summary: str = ""):
        super().__init__(json)
        self.summary = summary

    def __repr__(self) -> str:
        names = ", ".join(list(self)[:6]) + (f" and {len(self) - 6} more" if len(self) > 6 else "")
        return f"<twinbench.{type(self).__name__}: {names}>"

    def _repr_html_(self) -> str:
        if self.summary:
            return text(self.summary)
        return table(("part", "value"), ((name, short(value)) for name, value in self.items()))


class Results(Answer):
    """results.json of a run; names end in the unit, ``u_`` before a name is its standard uncertainty."""


def short(value: Any) -> str:
    """A value, or what is in it."""
    if isinstance(value, np.ndarray):
        finite = value[np.isfinite(value)]
        return f"{value.size} values" + (f", {finite.min():.6g} to {finite.max():.6g}" if finite.size else "")
    if isinstance(value, dict):
        return ", ".join(value)
    if isinstance(value, (list, tuple)):
        return f"{len(value)} entries"
    return f"{value:.6g}" if isinstance(value, float) else str(value)


def columns(named: Iterable[tuple[str, Any]]) -> str:
    """A row a column, with its unit."""
    def of(values: Any) -> str:
        return short(values) if isinstance(values, np.ndarray) else ", ".join(sorted(set(values)))[:80]

    return table(("column", "unit", "values"), ((name, unit_of(name) or "", of(values)) for name, values in named))


def text(words: str) -> str:
    return f"<pre>{html.escape(words)}</pre>"


def table(heads: Iterable[str], rows: Iterable[Iterable[str]]) -> str:
    def line(cells: Iterable[str], tag: str) -> str:
        return "<tr>" + "".join(f"<{tag}>{html.escape(cell)}</{tag}>" for cell in cells) + "</tr>"

    return "<table>" + line(heads, "th") + "".join(line(row, "td") for row in rows) + "</table>"

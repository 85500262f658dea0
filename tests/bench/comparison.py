"""The tables of docs/comparison.md, from comparison.json.

    python3 tests/bench/comparison.py FIGURES.json ...

replaces comparison.json by those of several runs, which `tests/bench --processor --json` and parse_only.py write. Each value
is the smallest of the runs' medians: other load on a machine only adds to times. comparison_plot.py makes the plot.
"""

from __future__ import annotations

import json
import pathlib
import sys
from typing import NamedTuple

FIGURES = pathlib.Path(__file__).with_name("comparison.json")
OURS = "PyDSLRep"
TOOLS = (OURS, "Langium", "textX", "tree-sitter")
SIZES = (100, 1000, 10000)
TIMES = "\N{MULTIPLICATION SIGN}"

LABELS = {
    "cold start": "cold start to first diagnostics",
    "hover": "hover",
    "open": "open, to diagnostics",
    "keystroke, syntax": "keystroke, syntax error",
    "keystroke, reference": "keystroke, broken reference",
    "keystroke + completion": "keystroke + completion",
    "burst of 200": "200 changes in a row",
    "symbols": "outline",
    "semantic tokens": "semantic tokens",
    "folding": "folding",
    "formatting": "formatting",
    "peak memory, MiB": "peak memory, MiB",
}


class Key(NamedTuple):
    """What is measured of which tool."""

    figure: str
    lines: int
    tool: str


def read(files: list[pathlib.Path]) -> dict[Key, float]:
    """The smallest values of several runs."""
    found: dict[Key, float] = {}
    for file in files:
        for row in json.loads(file.read_text(encoding="utf-8")):
            for tool, value in row["values"].items():
                if value is not None:
                    key = Key(row["figure"], row["lines"], tool)
                    found[key] = min(value, found.get(key, value))
    return found


def write(found: dict[Key, float]) -> None:
    """Writes comparison.json."""
    rows = [
        {
            "figure": figure,
            "lines": size,
            "values": {
                tool: rounded(found[Key(figure, size, tool)])
                for tool in TOOLS
                if Key(figure, size, tool) in found
            },
        }
        for figure in LABELS
        for size in SIZES
    ]
    text = ",\n".join(f" {json.dumps(row)}" for row in rows if row["values"])
    FIGURES.write_text(f"[\n{text}\n]\n", encoding="utf-8")


def rounded(value: float) -> float:
    """Two digits."""
    return float(f"{value:.2g}")


def table() -> str:
    """The table of times."""
    found = read([FIGURES])
    head = "".join(f" | {tool}" for tool in TOOLS)
    lines = [f"| figure | lines{head} |", "|---|---" + "|---" * len(TOOLS) + "|"]
    for figure, label in LABELS.items():
        for size in SIZES:
            values = [found.get(Key(figure, size, tool)) for tool in TOOLS]
            if any(value is not None for value in values):
                cells = "".join(f" | {cell(value, values[0])}" for value in values)
                lines.append(f"| {label} | {size:,}{cells} |".replace(",0", " 0"))
    return "\n".join(lines)


def cell(value: float | None, ours: float | None) -> str:
    """A value, and how many times ours it is."""
    if value is None:
        return ""
    text = f"{value:g}" if value < 1000 else f"{value:.0f}"
    if ours is None or value == ours:
        return text
    ratio = value / ours
    return (
        f"{text} ({ratio:.0f} {TIMES})"
        if ratio >= 10
        else f"{text} ({ratio:.1f} {TIMES})"
    )


if __name__ == "__main__":
    write(read([pathlib.Path(name) for name in sys.argv[1:]]))

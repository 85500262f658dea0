"""How long the tree-sitter grammar takes to parse, in this process: without a protocol, names or checks.

    .venv/bin/python tests/bench/parse_only.py [--sizes 100,1000,10000] [--json FILE]

Figures are those of `tests/bench --processor`, in milliseconds, as far as a parser has them.
"""

from __future__ import annotations

import argparse
import json
import pathlib
import statistics
import sys
import tempfile
import time

sys.path.insert(0, str(pathlib.Path(__file__).parents[1] / "grammars"))

import tree_sitter
from compiled_parser import compiled_parser
from program import Program, program

NAME = "tree-sitter"
SAMPLES = 60


def main() -> None:
    """Prints and writes the figures."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").split("\n", 1)[0])
    parser.add_argument("--sizes", default="100,1000,10000")
    parser.add_argument("--json", type=pathlib.Path, help="also write the figures here")
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        language = compiled_parser(pathlib.Path(folder))
    rows = []
    for size in map(int, options.sizes.split(",")):
        full, edit = parsing(tree_sitter.Parser(language), program(size))
        print(f"{size:>8} lines: parse {full:.3f} ms, keystroke {edit:.3f} ms")
        for figure, value in (("open", full), ("keystroke, syntax", edit)):
            rows.append({"figure": figure, "lines": size, "values": {NAME: value}})
    if options.json:
        options.json.write_text(json.dumps(rows, indent=1) + "\n", encoding="utf-8")


def parsing(parser: tree_sitter.Parser, text: Program) -> tuple[float, float]:
    """The medians of parsing a whole program, and of parsing it again after a keystroke."""
    source = text.text.encode()
    full = []
    for _ in range(SAMPLES):
        started = time.process_time()
        tree = parser.parse(source)
        full.append(time.process_time() - started)
        assert not tree.root_node.has_error
    line, column = text.unit
    at = sum(len(one.encode()) + 1 for one in text.lines[:line]) + column
    edits, is_wrong = [], False
    for _ in range(SAMPLES):
        old, new = (1, 0) if is_wrong else (0, 1)
        source = source[:at] + b"x" * new + source[at + old :]
        is_wrong = not is_wrong
        started = time.process_time()
        tree.edit(
            at,
            at + old,
            at + new,
            (line, column),
            (line, column + old),
            (line, column + new),
        )
        tree = parser.parse(source, tree)
        edits.append(time.process_time() - started)
        assert tree.root_node.has_error == is_wrong
    return 1000 * statistics.median(full), 1000 * statistics.median(edits)


if __name__ == "__main__":
    main()

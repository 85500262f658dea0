"""Writes which faults have happened in the tests into docs/reliability.md: `python3 table.py REPORT`.

REPORT is the file that the tests wrote with `PYDSLREP_HOSTILE_REPORT=REPORT`.
"""

from __future__ import annotations

import json
import pathlib
import sys
from collections import defaultdict

PAGE = pathlib.Path(__file__).parents[2] / "docs" / "reliability.md"
BEGIN, END = "<!-- faults -->\n", "<!-- /faults -->\n"

# The first word of a test's name in the report; what it injects; what must hold.
ROWS = {
    "messages": (
        "messages to the language server with parts replaced, removed, repeated or nested",
        "every request has one answer; all other answers are as before",
    ),
    "cancels": (
        "requests that are cancelled while they wait, while they compute, and while nobody reads their answers",
        "each ends with the error `RequestCancelled`; all other answers are as before",
    ),
    "soak": (
        "edits in one session, with a request after each",
        "memory, open files and threads stay as they were",
    ),
    "ports": (
        "sessions at the simulator's ports: recorded, changed, cut off",
        "the simulator drives the next script; its memory and open files stay as they were",
    ),
    "engine": (
        "answers of an engine to a script, `doctor`, `scene pull` and `scene push`: of another type or length, not finite, 1e308, an error of 1.6 MB, half, or none",
        "each ends in bounded time and memory with one message; files are as before",
    ),
    "kills": (
        "commands killed at any moment",
        "every file is as before or complete, only a trace may end early; no process and no temporary file stays",
    ),
    "writes": (
        "commands killed in the middle of a write",
        "as above",
    ),
    "limits": (
        "runs of commands on a disk that is full after any number of bytes",
        "an error with the file's name; every file is as before or complete",
    ),
}


def counts(report: pathlib.Path) -> dict[str, int]:
    """How many faults have happened in each test."""
    found: dict[str, int] = defaultdict(int)
    for line in report.read_text(encoding="utf-8").splitlines():
        entry = json.loads(line)
        found[entry["test"].split()[0]] += entry["happened"]
    return found


def table(found: dict[str, int]) -> str:
    """The table of the page."""
    lines = ["| Fault | Happened | What must hold |", "|---|---:|---|"]
    for name, (fault, holds) in ROWS.items():
        count = f"{found[name]:,}".replace(",", " ")
        lines.append(f"| {fault} | {count} | {holds} |")
    return "\n".join(lines) + "\n"


def main(report: str) -> None:
    """Replaces the table."""
    text = PAGE.read_text(encoding="utf-8")
    before, rest = text.split(BEGIN)
    after = rest.split(END)[1]
    text = before + BEGIN + table(counts(pathlib.Path(report))) + END + after
    PAGE.write_text(text, encoding="utf-8")


if __name__ == "__main__":
    main(sys.argv[1])

"""Lines of programs against lines of clients written by hand, counted as the article does: no blank lines, no comments."""

from __future__ import annotations

import io
import json
import pathlib
import subprocess
import tokenize

from driven import PAPER, ROOT, client
from evaluation import LINES_SAVED, pairs, saved, subjects

PROGRAMS = {
    1: PAPER / "table2_two_wheels.pyr",
    2: ROOT / "examples" / "crossing.pyr",
    3: PAPER / "table7_slam.pyr",
}
WHAT = {
    1: "one robot drives a U",
    2: "four robots drive at the same time",
    3: "one robot explores a closed area",
}

# What stands for nothing that somebody wrote.
LAYOUT = {
    tokenize.COMMENT,
    tokenize.NL,
    tokenize.NEWLINE,
    tokenize.INDENT,
    tokenize.DEDENT,
    tokenize.ENDMARKER,
}


def of_python(code: str) -> int:
    """Lines that hold code; a docstring is a comment."""
    lines: set[int] = set()
    is_first = True
    for token in tokenize.generate_tokens(io.StringIO(code).readline):
        if token.type in LAYOUT:
            is_first |= token.type in (tokenize.NEWLINE, tokenize.INDENT)
            continue
        if not (is_first and token.type == tokenize.STRING):
            lines.update(range(token.start[0], token.end[0] + 1))
        is_first = False
    return len(lines)


def of_program(command: str, program: pathlib.Path) -> int:
    """As `pydslrep stats` counts."""
    done = subprocess.run(
        [command, "stats", "--json", program], capture_output=True, check=True
    )
    return int(json.loads(done.stdout)["total"]["program"])


def table(command: str) -> str:
    """The table of the page."""
    rows = [
        "| environment | program | lines | by hand | lines | saved | the article's mean lines: PyDSLRep, Python | saved |",
        "|---|---|---|---|---|---|---|---|",
    ]
    evaluated = []
    for number, program in PROGRAMS.items():
        ours = of_program(command, program)
        python = of_python(client(number).read_text(encoding="utf-8"))
        percent = 100 * (1 - ours / python)
        cells = printed(number)
        if cells:
            evaluated.append(percent)
        rows.append(
            f"| {number}: {WHAT[number]} | {link(program)} | {ours} | {link(client(number))} | {python} "
            f"| {percent:.1f} % | {cells or 'not evaluated |'} |"
        )
    mean = sum(evaluated) / len(evaluated)
    rows.append(
        f"| mean of 1 and 2 | | | | | **{mean:.1f} %** | | {LINES_SAVED:.1f} % |"
    )
    return "\n".join(rows)


def printed(environment: int) -> str:
    """The cells of the article's figures, over both groups."""
    both = [pair for key, pair in pairs(subjects()).items() if key[0] == environment]
    if not both:
        return ""
    python, pydslrep = (
        sum(float(pair[tool].lines.mean()) for pair in both) / len(both)
        for tool in (0, 1)
    )
    percent = sum(saved(one.lines, two.lines) for one, two in both) / len(both)
    return f"{pydslrep:.1f}, {python:.1f} | {percent:.1f} %"


def link(file: pathlib.Path) -> str:
    """A link from the page to a file of the repository."""
    return f"[{file.name}](../{file.relative_to(ROOT).as_posix()})"

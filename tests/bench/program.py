"""Correct programs of any length, and positions in them for edits."""

from __future__ import annotations

from typing import NamedTuple

BLOCK = """\
wheel wl_{n} with radius 4.5
wheel wr_{n} with radius 4.5
sensor near_{n}
sensor far_{n}

robot robot_{n} type tw with port {port} has {{ wl_{n} wr_{n} }} wheels with sensors {{ near_{n}, far_{n} }}

movement out_{n} of robot_{n} {{
  move 2.5 meters at 12.0
  turn left 90.0
  move 40.0 centimeters
  turn right until {{ far_{n} }}
}}

movement back_{n} of robot_{n} {{
  // the way home
  turn left 180.0
  move 2.5 meters
}}

environment area_{n} has {{ robot_{n} }} robots with {{ out_{n} back_{n} }} moves

"""


class Site(NamedTuple):
    """A position between two characters, from zero."""

    line: int
    column: int


class Program(NamedTuple):
    """A program and the positions of its edits, near its middle."""

    lines: list[str]
    unit: Site
    """Before the last letter of a `meters`: an extra letter is a syntax error."""
    reference: Site
    """After the name of a sensor after `until`: an extra letter is an undeclared name."""
    robot: Site
    """After the name of a movement's robot."""

    @property
    def text(self) -> str:
        """The whole text."""
        return "\n".join(self.lines) + "\n"


def program(size: int) -> Program:
    """A program of at least so many lines, in complete blocks."""
    blocks = -(-size // BLOCK.count("\n"))
    lines = [
        line
        for block in range(1, blocks + 1)
        for line in BLOCK.format(n=f"{block:05}", port=10_000 + block).splitlines()
    ]
    block = f"{(blocks + 1) // 2:05}"
    return Program(
        lines,
        unit=before_last(lines, f"movement out_{block} ", "meters"),
        reference=after(lines, f"movement out_{block} ", f"far_{block}"),
        robot=after(lines, f"movement out_{block} ", f"robot_{block}"),
    )


def after(lines: list[str], start: str, word: str) -> Site:
    """After the first `word` at or below the line that begins with `start`."""
    first = next(number for number, line in enumerate(lines) if line.startswith(start))
    line = next(number for number in range(first, len(lines)) if word in lines[number])
    return Site(line, lines[line].index(word) + len(word))


def before_last(lines: list[str], start: str, word: str) -> Site:
    """Before the last letter of that word."""
    site = after(lines, start, word)
    return site._replace(column=site.column - 1)

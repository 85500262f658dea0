"""How a person types a program: one key after the other, and nothing that the editor has put there already.

Keys are characters, and these names: Enter, Tab, Down, End, BSpace, C-u (which deletes what is before the cursor).
"""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import dataclass

STEP = 2
COMMENT = re.compile(r"//.*|/\*.*?\*/")


def same_leader(comment: str) -> str:
    """That of the comment before."""
    found = re.match(r"//\s*", comment)
    return found[0] if found else ""


def usual_leader(_comment: str) -> str:
    """One blank, whatever the comment before has."""
    return "// "


@dataclass(frozen=True)
class Habits:
    """What an editor does by itself, so that who knows it does not do it again."""

    # After Enter, the line is indented as far as it should be. Elsewhere one presses Tab.
    indents: bool = True
    # After `{` there is a `}`. Where lines are indented, Enter between them puts it on a line of its own, and one goes down
    # to it.
    closes_braces: bool = False
    # After a line comment, Enter begins another one with the `//` and the blanks that this gives. Where another beginning
    # is wanted, one deletes it.
    leader: Callable[[str], str] = lambda _comment: ""
    # It is deleted at once by Ctrl+U; elsewhere one presses Backspace.
    deletes_by_line: bool = True
    # The last line of a file ends without Enter.
    ends_last_line: bool = False


@dataclass(frozen=True)
class Stroke:
    """A key, and which line of the program it is for, from 0."""

    key: str
    line: int


def strokes(program: str, habits: Habits) -> list[Stroke]:
    """The keys for a program, from an empty file on. Its comments begin and end on one line."""
    lines = program.split("\n")
    if habits.ends_last_line and lines[-1] == "":
        lines.pop()
    typed = [Stroke(key, 0) for key in lines[0]]
    open_braces = _opened([], lines[0])
    for number, line in enumerate(lines[1:], 1):
        text = line.lstrip(" ")
        goes_down = habits.closes_braces and habits.indents
        if goes_down and text.startswith("}") and open_braces[-1]:
            keys = ["Down", "End", *text.removeprefix("}")]
        else:
            steps = 0 if habits.indents else (len(line) - len(text)) // STEP
            before = lines[number - 1].lstrip()
            leader = habits.leader(before) if before.startswith("//") else ""
            keys = ["Enter", *["Tab"] * steps, *_after_leader(text, leader, habits)]
        typed += [Stroke(key, number) for key in keys]
        open_braces = _opened(open_braces, line)
    return typed


def _after_leader(text: str, leader: str, habits: Habits) -> list[str]:
    """The keys for a line that begins as a comment already."""
    if text.startswith(leader):
        return list(text.removeprefix(leader))
    deleted = ["C-u"] if habits.deletes_by_line else ["BSpace"] * len(leader)
    return [*deleted, *text]


def _opened(before: list[bool], line: str) -> list[bool]:
    """The braces that are open after a line: of each, whether it was the last on its line."""
    after = list(before)
    code = COMMENT.sub("", line).rstrip()
    for place, sign in enumerate(code, 1):
        if sign == "{":
            after.append(place == len(code))
        elif sign == "}":
            after.pop()
    return after

"""Turns a program into keys, as a person types it: key by key, without what the editor inserts by itself.

Keys are characters and these names: Enter, Tab, Down, End, Right, BSpace, C-u (deletes everything before the cursor).
"""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import dataclass, replace

STEP = 2
COMMENT = re.compile(r"//.*|/\*.*?\*/")


def same_leader(comment: str) -> str:
    """The leader of the previous comment."""
    found = re.match(r"//\s*", comment)
    return found[0] if found else ""


def usual_leader(_comment: str) -> str:
    """One blank, whatever the previous comment has."""
    return "// "


@dataclass(frozen=True)
class Behaviour:
    """What an editor inserts by itself."""

    # Enter indents the next line. Otherwise, Tab does.
    indents: bool = True
    # `{` inserts a `}`. If Enter indents, Enter between them moves the `}` to its own line, and Down reaches it. Otherwise,
    # it stays after the cursor, and End passes it; Right does if those of outer blocks are there, too.
    closes_braces: bool = False
    # After a line comment, Enter starts another one with the `//` and blanks that this returns. It is deleted where the
    # program differs.
    leader: Callable[[str], str] = lambda _comment: ""
    # Ctrl+U deletes the leader. Otherwise, Backspace does.
    deletes_by_line: bool = True
    # The editor ends the last line of a file.
    ends_last_line: bool = False


@dataclass(frozen=True)
class Stroke:
    """A key and its line in the program, from 0."""

    key: str
    line: int


def strokes(
    program: str, behaviour: Behaviour, *, tabs: bool = False, as_written: bool = False
) -> list[Stroke]:
    """The keys for a program, starting from an empty file. Its comments must be on one line.

    `tabs` presses Tab after each word of a list that is on one line. `as_written` types every brace, whether or not the
    editor inserts it.
    """
    if as_written:
        behaviour = replace(behaviour, closes_braces=False)
    typed = _typed(program, behaviour)
    return _with_tabs(typed) if tabs else typed


def _with_tabs(typed: list[Stroke]) -> list[Stroke]:
    """Adds Tab after each word of a list."""
    found: list[Stroke] = []
    depth, is_word = 0, False
    for stroke in typed:
        if is_word and stroke.key == " ":
            found.append(Stroke("Tab", stroke.line))
        is_word = depth > 0 and (stroke.key.isalnum() and len(stroke.key) == 1)
        depth = _depth_on_line(found, depth, stroke)
        found.append(stroke)
    return found


def _depth_on_line(before: list[Stroke], depth: int, stroke: Stroke) -> int:
    """How many lists are open on the line after a key."""
    if before and before[-1].line != stroke.line:
        depth = 0
    return depth + (stroke.key == "{") - (stroke.key == "}")


def _typed(program: str, behaviour: Behaviour) -> list[Stroke]:
    lines = program.split("\n")
    if behaviour.ends_last_line and lines[-1] == "":
        lines.pop()
    typed = [Stroke(key, 0) for key in lines[0]]
    open_braces = _opened([], lines[0])
    for number, line in enumerate(lines[1:], 1):
        text = line.lstrip(" ")
        closes = text.startswith("}") and behaviour.closes_braces and open_braces[-1]
        if closes and behaviour.indents:
            keys = ["Down", "End", *text.removeprefix("}")]
        elif closes:
            steps = (len(line) - len(text)) // STEP
            passes = "End" if sum(open_braces) == 1 else "Right"
            keys = ["Enter", *["Tab"] * steps, passes, *text.removeprefix("}")]
        else:
            steps = 0 if behaviour.indents else (len(line) - len(text)) // STEP
            before = lines[number - 1].lstrip()
            leader = behaviour.leader(before) if before.startswith("//") else ""
            keys = ["Enter", *["Tab"] * steps, *_after_leader(text, leader, behaviour)]
        typed += [Stroke(key, number) for key in keys]
        open_braces = _opened(open_braces, line)
    return typed


def _after_leader(text: str, leader: str, behaviour: Behaviour) -> list[str]:
    """The keys for a line that already starts with a comment leader."""
    if text.startswith(leader):
        return list(text.removeprefix(leader))
    deleted = ["C-u"] if behaviour.deletes_by_line else ["BSpace"] * len(leader)
    return [*deleted, *text]


def _opened(before: list[bool], line: str) -> list[bool]:
    """For each brace that is open after a line, whether it was the last on its line."""
    after = list(before)
    code = COMMENT.sub("", line).rstrip()
    for place, sign in enumerate(code, 1):
        if sign == "{":
            after.append(place == len(code))
        elif sign == "}":
            after.pop()
    return after

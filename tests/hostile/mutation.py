"""Random changes of JSON values and of bytes."""

from __future__ import annotations

import random
from typing import Any

STRANGE: list[Any] = [
    None,
    True,
    0,
    -1,
    2**31,
    2**53,
    2**64,
    -(2**63),
    1e300,
    0.5,
    "",
    "\0",
    "\ud800",  # half of a character
    "é" * 3,
    "💥\u202e",
    "x" * 70_000,
    [],
    {},
    [[[[]]]],
    {"line": 4_294_967_295, "character": 4_294_967_295},
    "file:",
    "file://other/share/a.pyr",
    "file:///%FF%00.pyr",
    "file:///c%3A/a.pyr",
    "untitled:Untitled-1",
    "https://example.org/a.pyr",
    "not a URI",
]


def mutated(value: Any, dice: random.Random) -> Any:
    """A copy of a value with a change somewhere in it."""
    if isinstance(value, dict) and value and dice.random() < 0.85:
        key = dice.choice(list(value))
        changed = dict(value)
        match dice.random():
            case p if p < 0.75:
                changed[key] = mutated(value[key], dice)
            case p if p < 0.9:
                del changed[key]
            case _:
                changed[dice.choice(["", "uri", "range", "x" * 999])] = value
        return changed
    if isinstance(value, list) and value and dice.random() < 0.85:
        index = dice.randrange(len(value))
        match dice.random():
            case p if p < 0.7:
                return [
                    *value[:index],
                    mutated(value[index], dice),
                    *value[index + 1 :],
                ]
            case p if p < 0.8:
                return value[:index] + value[index + 1 :]
            case _:
                return value * dice.choice([2, 100])
    if isinstance(value, int) and dice.random() < 0.5:
        return value + dice.choice([-1, 1, 1000])
    if isinstance(value, str) and value and dice.random() < 0.4:
        at = dice.randrange(len(value) + 1)
        return value[:at] + dice.choice(["\0", "💥", "{", "/*", ""]) + value[at + 1 :]
    return nested(dice) if dice.random() < 0.05 else dice.choice(STRANGE)


def nested(dice: random.Random) -> Any:
    """A value that is nested deeply, but not deeper than the server reads."""
    value: Any = 0
    for _ in range(dice.choice([10, 100])):
        value = [value] if dice.random() < 0.5 else {"a": value}
    return value


def mangled(data: bytes, dice: random.Random) -> bytes:
    """A copy of bytes with up to three changes."""
    found = bytearray(data)
    for _ in range(dice.randint(1, 3)):
        at = dice.randrange(len(found) + 1)
        upto = min(len(found), at + dice.choice([1, 2, 4, 40]))
        match dice.randrange(5):
            case 0 if at < len(found):
                found[at] ^= 1 << dice.randrange(8)
            case 1:
                found[at:upto] = dice.randbytes(upto - at)
            case 2:
                found[at:at] = dice.choice([b"\0", b"\xff" * 8, dice.randbytes(9)])
            case 3:
                found[at:at] = found[at:upto]
            case _:
                del found[at:upto]
    return bytes(found)

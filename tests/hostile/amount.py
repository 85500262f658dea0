"""How much the tests inject, and where they report it."""

from __future__ import annotations

import json
import os
import pathlib
import random

FACTOR = int(os.environ.get("PYDSLREP_HOSTILE", "1"))
SEED = int(os.environ.get("PYDSLREP_HOSTILE_SEED", "1"))
REPORT = os.environ.get("PYDSLREP_HOSTILE_REPORT")


def times(few: int) -> int:
    """The number of faults to inject, of which a short run injects `few`."""
    return few * FACTOR


def dice(test: str) -> random.Random:
    """The random generator of a test."""
    return random.Random(f"{SEED} {test}")


def report(test: str, happened: int, tried: int | None = None) -> None:
    """Notes how many faults have happened; of those that were tried, which may be more, at least a third must have."""
    tried = happened if tried is None else tried
    assert 3 * happened >= tried > 0, f"{test}: of {tried} faults, {happened} happened"
    if REPORT:
        found = {"test": test, "seed": SEED, "happened": happened, "tried": tried}
        with pathlib.Path(REPORT).open("a", encoding="utf-8") as file:
            print(json.dumps(found), file=file)

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


def report(test: str, **injected: int) -> None:
    """Notes what a test has injected."""
    if REPORT:
        with pathlib.Path(REPORT).open("a", encoding="utf-8") as file:
            print(json.dumps({"test": test, "seed": SEED, **injected}), file=file)

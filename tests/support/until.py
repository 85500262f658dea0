"""Waiting for a state: the one place where tests look at a clock."""

from __future__ import annotations

import time
from collections.abc import Callable
from typing import TypeVar

T = TypeVar("T")

# What takes longer does not happen, however busy the machine is: seconds.
LIMIT = 60.0

PAUSE = 0.01  # s


def until(
    what: str,
    look: Callable[[], T],
    seen: Callable[[], object] | None = None,
    limit: float = LIMIT,
) -> T:
    """Looks again and again until it gets something, and returns that; otherwise the test fails with what `seen` says."""
    deadline = time.monotonic() + limit
    while not (found := look()):
        if time.monotonic() > deadline:
            state = f"; instead: {seen()}" if seen else ""
            raise AssertionError(f"{what}: not within {limit:.0f} s{state}")
        time.sleep(PAUSE)
    return found

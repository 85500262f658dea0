"""Which cases of a test only run at full length."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

import pytest


def few(number: int, cases: Iterable[Any]) -> list[Any]:
    """Parameters of a test, of which all but the first few run with `--long` only. A tuple is several parameters."""
    found = []
    for place, case in enumerate(cases):
        values = case if isinstance(case, tuple) else (case,)
        marks = pytest.mark.long if place >= number else ()
        found.append(pytest.param(*values, marks=marks))
    return found

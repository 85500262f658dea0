"""Where mypy keeps what it knows about modules that stay the same from test to test."""

import os
from pathlib import Path

ROOT = Path(__file__).parents[2]


def option() -> str:
    """The option of mypy. Every process of pytest has a folder of its own: mypy may not share one with itself."""
    process = os.environ.get("PYTEST_XDIST_WORKER", "alone")
    return f"--cache-dir={ROOT / 'target' / 'tests' / 'mypy' / process}"

"""Where mypy keeps what it knows about modules that stay the same from test to test."""

import os
from pathlib import Path

ROOT = Path(__file__).parents[2]


def option() -> str:
    """The option of mypy. Each process of pytest has its own folder, so that no two runs of mypy use one at the same time."""
    process = os.environ.get("PYTEST_XDIST_WORKER", "alone")
    return f"--cache-dir={ROOT / 'target' / 'tests' / 'mypy' / process}"

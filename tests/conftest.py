"""The path of the command under test."""

from __future__ import annotations

import os
import pathlib
import signal

import pytest

ROOT = pathlib.Path(__file__).parents[1]
DEBUG = pathlib.Path(os.environ.get("CARGO_TARGET_DIR", ROOT / "target")) / "debug"

# In the background of a shell, tests would otherwise pass an ignored SIGINT on to the processes they start.
signal.signal(signal.SIGINT, signal.default_int_handler)


@pytest.fixture
def command() -> str:
    """The path of `pydslrep`."""
    return os.environ.get("PYDSLREP", str(DEBUG / "pydslrep"))

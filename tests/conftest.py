"""Where the command under test is."""

from __future__ import annotations

import os
import pathlib
import signal

import pytest

ROOT = pathlib.Path(__file__).parents[1]
DEBUG = pathlib.Path(os.environ.get("CARGO_TARGET_DIR", ROOT / "target")) / "debug"

# Started in the background of a shell, tests would pass on to what they start that it is not to be interrupted.
signal.signal(signal.SIGINT, signal.default_int_handler)


@pytest.fixture
def command() -> str:
    """The program `pydslrep`."""
    return os.environ.get("PYDSLREP", str(DEBUG / "pydslrep"))

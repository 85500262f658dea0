"""Where the command under test is."""

from __future__ import annotations

import os
import pathlib

import pytest

ROOT = pathlib.Path(__file__).parents[1]
DEBUG = pathlib.Path(os.environ.get("CARGO_TARGET_DIR", ROOT / "target")) / "debug"


@pytest.fixture
def command() -> str:
    """The program `pydslrep`."""
    return os.environ.get("PYDSLREP", str(DEBUG / "pydslrep"))

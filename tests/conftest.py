"""The command under test, and a simulator to connect to."""

from __future__ import annotations

import os
import pathlib
import re
import signal
import subprocess
from collections.abc import Iterator

import pytest

ROOT = pathlib.Path(__file__).parents[1]
DEBUG = pathlib.Path(os.environ.get("CARGO_TARGET_DIR", ROOT / "target")) / "debug"

# In the background of a shell, tests would otherwise pass an ignored SIGINT on to the processes they start.
signal.signal(signal.SIGINT, signal.default_int_handler)


@pytest.fixture
def command() -> str:
    """The path of `pydslrep`."""
    return os.environ.get("PYDSLREP", str(DEBUG / "pydslrep"))


@pytest.fixture
def port(command: str) -> Iterator[int]:
    """The port of a simulator with an empty floor, which is started for the test."""
    simulator = subprocess.Popen(
        [command, "sim", "--empty", "--port", "0"], stdout=subprocess.PIPE, text=True
    )
    assert simulator.stdout is not None
    ready = re.search(r":(\d+)", simulator.stdout.readline())
    assert ready is not None
    yield int(ready[1])
    simulator.send_signal(signal.SIGINT)
    simulator.communicate(timeout=60)

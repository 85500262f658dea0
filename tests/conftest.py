"""The command under test, and a simulator to connect to."""

from __future__ import annotations

import os
import pathlib
import re
import signal
import subprocess
from collections.abc import Iterator

import pytest
from signals_kept import signals_kept

__all__ = ["signals_kept"]

ROOT = pathlib.Path(__file__).parents[1]
DEBUG = pathlib.Path(os.environ.get("CARGO_TARGET_DIR", ROOT / "target")) / "debug"

# They run in environments of their own: tests/ros/run.sh.
collect_ignore = ["ros"]


def pytest_addoption(parser: pytest.Parser) -> None:
    parser.addoption(
        "--long", action="store_true", help="Run everything at full length."
    )


def pytest_collection_modifyitems(
    config: pytest.Config, items: list[pytest.Item]
) -> None:
    """Leaves out tests marked `long`, of which others are the short subset; at full length, no test counts as hung."""
    if config.getoption("long"):
        for item in items:
            item.add_marker(pytest.mark.timeout(0))
    if not config.getoption("long"):
        left_out = [item for item in items if item.get_closest_marker("long")]
        items[:] = [item for item in items if not item.get_closest_marker("long")]
        config.hook.pytest_deselected(items=left_out)


@pytest.fixture(scope="session")
def long(pytestconfig: pytest.Config) -> bool:
    """Whether tests run at full length: by default, those that need more than 20 s run a short subset."""
    return bool(pytestconfig.getoption("long"))


@pytest.fixture(scope="session")
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

"""Scripts of the target ros2, the robots that they drive, and a domain of ROS 2 for each test."""

from __future__ import annotations

import fcntl
import os
import pathlib
import signal
import subprocess
import sys
import tempfile
from collections.abc import Callable, Iterator

import pytest

# The middleware reads it when the first context begins.
os.environ["ROS_AUTOMATIC_DISCOVERY_RANGE"] = "LOCALHOST"
# The loader of the wheels sets them for this Python: one of another release would find the wrong libraries.
for name in ("_ROS_WHEELS_BOOTSTRAP_COMPLETE", "LD_LIBRARY_PATH"):
    os.environ.pop(name, None)

ROOT = pathlib.Path(__file__).parents[2]
DEBUG = pathlib.Path(os.environ.get("CARGO_TARGET_DIR", ROOT / "target")) / "debug"
DOMAINS = range(1, 100)
END_LIMIT = 60  # s, after which a process counts as hung; none needs a tenth of it

for name in ("SIGINT", "SIGQUIT", "SIGHUP"):
    # What a shell ignores in the background, processes would inherit.
    signal.signal(getattr(signal, name), signal.SIG_DFL)
signal.signal(signal.SIGINT, signal.default_int_handler)


def pytest_addoption(parser: pytest.Parser) -> None:
    parser.addoption(
        "--long", action="store_true", help="Run everything at full length."
    )


def pytest_collection_modifyitems(
    config: pytest.Config, items: list[pytest.Item]
) -> None:
    """Leaves out tests marked `long`, of which others are the short subset."""
    if not config.getoption("long"):
        left_out = [item for item in items if item.get_closest_marker("long")]
        items[:] = [item for item in items if not item.get_closest_marker("long")]
        config.hook.pytest_deselected(items=left_out)


@pytest.fixture(autouse=True)
def domain(monkeypatch: pytest.MonkeyPatch) -> Iterator[int]:
    """A domain that no other test on this machine has: a script would drive their robots."""
    for number in DOMAINS:
        path = pathlib.Path(tempfile.gettempdir()) / f"pydslrep-ros-domain-{number}"
        with path.open("w") as lock:
            try:
                fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
            except BlockingIOError:
                continue
            monkeypatch.setenv("ROS_DOMAIN_ID", str(number))
            # On a busy machine, it takes a while until all know each other.
            limit = f"CONNECT_TIMEOUT={END_LIMIT}"
            monkeypatch.setenv("PYDSLREP_TIME_LIMITS", limit)
            yield number
            return
    pytest.fail("all domains are taken")


@pytest.fixture
def command() -> str:
    """The path of `pydslrep`."""
    return os.environ.get("PYDSLREP", str(DEBUG / "pydslrep"))


SHORT = """wheel l with radius 4.5
wheel r with radius 4.5
sensor front : distance
robot rover with port 23000 has { l r } wheels with sensors { front }
movement m of rover { move 30 centimeters turn right move 2 meters until { front } detect within 50 centimeters }
environment yard has { rover } robots with { m } moves
"""
SCENE = "[[wall]]\nfrom = [-1, -0.9]\nto = [2, -0.9]\n"


@pytest.fixture
def short(tmp_path: pathlib.Path) -> pathlib.Path:
    """A program with a turn and a condition, and its scene."""
    program = tmp_path / "short.pyr"
    program.write_text(SHORT, encoding="utf-8")
    (tmp_path / "yard.scene.toml").write_text(SCENE, encoding="utf-8")
    return program


Start = Callable[..., "subprocess.Popen[str]"]


@pytest.fixture
def start() -> Iterator[Start]:
    """Starts processes that end with the test."""
    started: list[subprocess.Popen[str]] = []

    def start(*arguments: object) -> subprocess.Popen[str]:
        process = subprocess.Popen(
            [*map(str, arguments)],
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            text=True,
        )
        started.append(process)
        return process

    yield start
    for process in started:
        process.kill()
        process.communicate()


SCRIPT = """
from pydslrep_runtime import {robot_type}, clear, detects, run

rover = {robot_type}("rover", port=23000, {arguments})


async def yard() -> None:
    {body}


run(yard, robots=[rover], backend="ros2")
"""

WHEELS = {
    "TwoWheelRobot": 'left=("l", 0.045), right=("r", 0.045)',
    "MecanumRobot": ", ".join(
        f'{place}=("{place}", 0.05)'
        for place in ("left_front", "left_rear", "right_front", "right_rear")
    ),
}


@pytest.fixture
def script(tmp_path: pathlib.Path, start: Start) -> Start:
    """Starts a script whose body is given, in simulated time."""

    def script(
        body: str,
        arguments: str = "",
        *options: str,
        robot_type: str = "TwoWheelRobot",
        python: str = sys.executable,
    ) -> subprocess.Popen[str]:
        path = tmp_path / "yard.py"
        wheels = f"{WHEELS[robot_type]}, {arguments}"
        text = SCRIPT.format(robot_type=robot_type, arguments=wheels, body=body)
        path.write_text(text, encoding="utf-8")
        return start(python, path, *(options or ("--sim-time",)))

    return script


def said(process: subprocess.Popen[str]) -> str:
    """All that a process has written, once it has ended."""
    output, _ = process.communicate(timeout=END_LIMIT)
    return output

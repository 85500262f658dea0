"""A running simulator and scripts for it, each in its own process."""

from __future__ import annotations

import json
import math
import os
import pathlib
import shutil
import signal
import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager

import sim
from until import LIMIT, until

HERE = pathlib.Path(__file__).parent
ROOT = HERE.parents[1]
CLIENT = HERE / "sim.py"

TARGETS = ("coppeliasim", "vrep")

# Robot `other` is only in environment `world`: its port is for the observer.
PROGRAM = """
wheel wheelL with radius 4.5
wheel wheelR with radius 4.5
robot rover with port {0} has {{ wheelL wheelR }} wheels
robot other with port {1} has {{ wheelL wheelR }} wheels
movement trip of rover {{ {actions} }}
environment yard has {{ rover }} robots with {{ trip }} moves
environment world has {{ rover other }} robots
"""

BLOCKING = sim.simx_opmode_blocking

# Appended to a script's module that writes the trace: at one of its steps, the script waits for the test.
MEETING = """

class HaltingTrace(Trace):
    def __init__(self, *file: object) -> None:
        super().__init__(*file)
        self.steps, self.is_written = 0, True

    def add(self, *values: object) -> None:
        super().add(*values)
        self.steps += 1
        if self.steps == {step}:
            with open({place!r}, "rb") as meeting:
                meeting.read()


Trace = HaltingTrace
"""

Pose = tuple[float, float, float]


class Stage:
    """A folder with a program and its scripts."""

    def __init__(self, command: str, folder: pathlib.Path, program: str) -> None:
        self.command, self.folder = command, folder
        folder.mkdir(exist_ok=True)
        self.program = folder / "program.pyr"
        self.program.write_text(program, encoding="utf-8")

    def build(self, target: str, environment: str = "yard") -> pathlib.Path:
        """Generates the script for a target, with V-REP's client next to it if needed."""
        folder = self.folder / target
        which = ["--environment", environment, "--target", target, "-o", str(folder)]
        build = [self.command, "build", str(self.program), *which]
        subprocess.run(build, check=True, stdout=subprocess.DEVNULL)
        if target == "vrep":
            shutil.copy(CLIENT, folder)
        return folder / f"{environment}.py"

    @contextmanager
    def simulator(self, *options: str) -> Iterator[subprocess.Popen[str]]:
        """Starts the simulator of the program and waits until it is ready."""
        process = subprocess.Popen(
            [self.command, "sim", self.program, "--environment", "world", *options],
            stdout=subprocess.PIPE,
            text=True,
        )
        try:
            assert process.stdout is not None
            assert "robot" in process.stdout.readline()
            yield process
        finally:
            process.kill()
            process.communicate()


@contextmanager
def onlooker(port: int) -> Iterator[int]:
    """A client that only observes, and keeps the simulation running between scripts."""
    number = sim.simxStart("127.0.0.1", port, True, True, 5000, 5)
    assert number >= 0
    try:
        assert sim.simxStartSimulation(number, BLOCKING) == 0
        yield number
    finally:
        sim.simxFinish(number)


def start(script: pathlib.Path, *options: str) -> subprocess.Popen[str]:
    """Starts a script."""
    return subprocess.Popen(
        [sys.executable, script, *options],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        # Keep the modules of the tests off its path.
        cwd=script.parent,
        env={key: value for key, value in os.environ.items() if key != "PYTHONPATH"},
    )


class Halt:
    """A step of a script at which it waits for the test, however fast or slow either of them is."""

    def __init__(self, script: pathlib.Path, step: int = 20) -> None:
        self._place = script.parent / "meeting"
        os.mkfifo(self._place)
        module = script.parent / "pydslrep_runtime" / "trace.py"
        with module.open("a", encoding="utf-8") as file:
            file.write(MEETING.format(step=step, place=str(self._place)))

    @contextmanager
    def reached(self, script: subprocess.Popen[str]) -> Iterator[None]:
        """Waits until the script is there, and lets it go on afterwards."""

        def meet() -> int:
            assert script.poll() is None, script.communicate()
            try:
                return os.open(self._place, os.O_WRONLY | os.O_NONBLOCK)
            except OSError:
                return 0  # nobody reads yet

        with os.fdopen(until("the script is in the middle of its path", meet), "wb"):
            yield


def note(script: subprocess.Popen[str], words: str) -> None:
    """Waits until a script says something."""
    assert script.stderr is not None
    for line in script.stderr:
        if words in line:
            return
    raise AssertionError(script.communicate())


def finish(process: subprocess.Popen[str], code: int = 0) -> tuple[str, str]:
    """Waits for the end of a script, checks its exit code, and returns its output."""
    try:
        out, err = process.communicate(timeout=LIMIT)
    finally:
        process.kill()
    assert process.returncode == code, err
    return out, err


def wait_for_motion(eye: int, script: subprocess.Popen[str]) -> int:
    """Waits until the rover drives, and returns its left wheel."""
    left = handle(eye, "/rover/wheelL")
    while wheel_rate(eye, left) < 0.5:
        assert script.poll() is None, script.communicate()
    return left


def wait_for_rest(eye: int, wheel: int) -> None:
    """Waits until a wheel stops, long before its path ends."""
    wheel_rate(eye, wheel)
    begin = sim.simxGetLastCmdTime(eye)

    def rests() -> bool:
        rate = wheel_rate(eye, wheel)
        assert rate == 0.0 or sim.simxGetLastCmdTime(eye) <= begin + 10_000, "drives on"
        return rate == 0.0

    until("the wheel rests", rests, lambda: f"{wheel_rate(eye, wheel)} rad/s")


def handle(eye: int, name: str) -> int:
    """The handle of an object."""
    code, found = sim.simxGetObjectHandle(eye, name, BLOCKING)
    assert code == 0
    return found


def wheel_rate(eye: int, wheel: int) -> float:
    """The rate of a wheel, rad/s."""
    code, rate = sim.simxGetObjectFloatParameter(eye, wheel, 2012, BLOCKING)
    assert code == 0
    return rate


def interrupt(process: subprocess.Popen[str]) -> None:
    """Interrupts a process, as Ctrl-C does."""
    process.send_signal(signal.SIGINT)


def ends(trace: pathlib.Path) -> dict[str, Pose]:
    """The robots' last poses: metres and degrees."""
    found: dict[str, Pose] = {}
    for line in trace.read_text(encoding="utf-8").splitlines():
        row = json.loads(line)
        found[row["robot"]] = (row["x"], row["y"], math.degrees(row["theta"]))
    return found


def assert_near(
    end: Pose, goal: Pose, metres: float = 0.005, degrees: float = 0.5
) -> None:
    """Asserts that a pose is within the tolerance of actions."""
    off = math.dist(end[:2], goal[:2])
    turned = abs(math.remainder(end[2] - goal[2], 360.0))
    assert (off <= metres, turned <= degrees) == (True, True), f"{end}, not {goal}"

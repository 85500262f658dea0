"""Measures what it takes to control robots in Python: no simulator, no sockets, an ideal robot in the same process.

    python3 tests/bench/control.py [--robots 1,4] [--runs 15] [--profile]

A robot drives a square of 2 m; figures are microseconds of processor time per step and robot, those of the ideal robot left
out. `--profile` lists the functions that they pass in.
"""

from __future__ import annotations

import argparse
import asyncio
import contextlib
import cProfile
import io
import math
import pathlib
import pstats
import sys
import time
from collections.abc import Sequence

sys.path.insert(0, str(pathlib.Path(__file__).parents[2] / "python"))

from pydslrep_runtime import Backend, Pose, TwoWheelRobot, movements, parallel
from pydslrep_runtime.event_loop import SimulationLoop
from pydslrep_runtime.trace import Trace

TRACK, RADIUS, STEP = 0.30, 0.045, 0.05


class Clock:
    """The clock of all robots."""

    def __init__(self) -> None:
        self.time, self.time_step, self.steps = 0.0, STEP, 0
        self.robots: list[Ideal] = []

    def advance(self) -> None:
        """Moves all robots."""
        for robot in self.robots:
            robot.move_on()
        self.time += STEP
        self.steps += 1


class Ideal(Backend):
    """A robot with two wheels that do as they are told."""

    def __init__(self, clock: Clock) -> None:
        self.clock = clock
        clock.robots.append(self)
        self._x = self._y = self._theta = 0.0
        self._rates: Sequence[float] = (0.0, 0.0)

    def wheel_mounts(self) -> Sequence[tuple[float, float]]:
        """On one axle."""
        return [(0.0, TRACK / 2.0), (0.0, -TRACK / 2.0)]

    def set_wheel_rates(self, rates: Sequence[float]) -> None:
        """Until the next call."""
        self._rates = rates

    def pose(self) -> Pose:
        """Exact."""
        return Pose(self._x, self._y, self._theta)

    def move_on(self) -> None:
        """Moves for a step."""
        left, right = self._rates
        ahead = (left + right) * RADIUS / 2.0 * STEP
        turn = (right - left) * RADIUS / TRACK * STEP
        middle = self._theta + turn / 2.0
        self._x += ahead * math.cos(middle)
        self._y += ahead * math.sin(middle)
        self._theta = math.remainder(self._theta + turn, math.tau)


async def square(robot: TwoWheelRobot) -> None:
    """What a robot does."""
    for _ in range(4):
        await robot.move(2.0)
        await robot.turn(90.0)


def drive(count: int) -> tuple[float, Clock]:
    """Drives robots in parallel; the seconds of processor time that it takes, and their clock."""
    clock, loop = Clock(), SimulationLoop()
    robots = []
    for index in range(count):
        robot = TwoWheelRobot(
            f"r{index}", port=1, left=("l", RADIUS), right=("r", RADIUS)
        )
        robot.connect(robot.spec("", 1), Ideal(clock), loop, index, Trace())
        robots.append(robot)

    async def main() -> None:
        movements.current.set(movements.Movement("square"))
        if count == 1:
            await square(robots[0])
        else:
            await parallel(*map(square, robots))

    with asyncio.Runner(loop_factory=lambda: loop) as runner:
        loop.use_clock(clock)
        began = time.process_time()
        with contextlib.redirect_stdout(io.StringIO()):
            runner.run(main())
        seconds = time.process_time() - began
        loop.use_clock(None)
    return seconds, clock


def alone(steps: int) -> float:
    """The seconds that an ideal robot takes for its own part."""
    clock = Clock()
    robot = Ideal(clock)
    rates = [1.0, 1.0]
    began = time.process_time()
    for _ in range(steps):
        robot.set_wheel_rates(rates)
        clock.advance()
        robot.pose()
    return time.process_time() - began


def main() -> None:
    """Measures and prints."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("--robots", default="1,4")
    parser.add_argument("--runs", type=int, default=15)
    parser.add_argument("--profile", action="store_true")
    options = parser.parse_args()
    if options.profile:
        with cProfile.Profile() as profile:
            drive(1)
        pstats.Stats(profile).sort_stats("tottime").print_stats(25)
        return
    for count in map(int, options.robots.split(",")):
        runs = [drive(count) for _ in range(options.runs)]
        steps = runs[0][1].steps
        own = min(alone(steps) for _ in range(options.runs))
        best = min(seconds for seconds, _ in runs) / count - own
        print(f"{count} robots: {1e6 * best / steps:.1f} us per step and robot")


if __name__ == "__main__":
    main()
